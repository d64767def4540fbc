// Our matchers beside OpenCV's on scenes with known truth, each at its own settings: the Middlebury evaluation, version 2.
#pragma once

#include <array>
#include <cstddef>
#include <filesystem>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "duoptic/engine.h"
#include "duoptic/evaluation.h"
#include "duoptic/peers.h"
#include "duoptic/result.h"

namespace [[gnu::visibility("default")]] duo {

/// One of our matchers.
struct SceneMatcher {
  std::string name = {};  // in tables
  std::string engine = "auto";
  int threads = 1;
  Setup setup = {};        // size, disparities and rows are the scene's
  bool keep_rows = false;  // rows that disagree are not put right, as `duoptic depth` does
};

struct SceneContest {
  std::vector<SceneMatcher> ours;
  std::vector<Peer> peers = {};
  int threads = 1;  // of the peers
};

struct SceneScore {
  std::string scene;
  DisparityScore score;
  double ms = 0;  // of a frame, the peers' of their matching call alone
};

/// What one method found, scene by scene.
struct MethodScores {
  std::string method;
  std::vector<SceneScore> scenes;

  /// Mean over scenes and regions of bad pixels in per cent, by place in kBadThresholds_px; over the four scenes of version 2
  /// it is that evaluation's mean.
  double filled_percent(std::size_t threshold) const;
  double holes_bad_percent(std::size_t threshold) const;
  /// Of scenes [begin, end) alone.
  MethodScores part(std::size_t begin, std::size_t end) const;
  /// Of the scenes of version 2 alone, and whether it has all four.
  MethodScores v2() const;
  bool has_v2() const;
};

/// The table of the thesis of 2010: bad-1.0, per cent, nonocc / all / disc of the scenes of version 2; and its mean.
const std::map<std::string, std::array<double, 3>>& thesis_percent();
inline constexpr double kThesisMean_percent = 32.5;

/// Methods without scenes, ours first.
std::vector<MethodScores> methods_of(const SceneContest& contest);
/// All methods on a scene. `progress`: how much of the frame of a slow matcher is done, 0 .. 1.
///
/// Returns  the disparity of our first, px, negative = none
/// Errors   those of make_engine() and Engine::prepare()
Result<Image<float>> add_scene(const SceneContest& contest, const StereoScene& scene, std::vector<MethodScores>& methods,
                               const std::function<void(double)>& progress = {});

/// The scene with this fault in its pictures.
StereoScene perturb(const StereoScene& scene, const Perturbation& how);

/// Right within 1 px: gray by its error; wrong in a seen region: red; wrong where occluded: blue; hole: black.
Image<Rgb8> draw_errors(const Image<float>& d_px, const StereoScene& scene);

/// Scenes of one folder that was named, among several: places in all of them.
struct SceneGroup {
  std::string name;
  std::size_t begin = 0, end = 0;
};
/// All scenes in their order; in `groups` the folders that hold several, where there are others beside them.
///
/// Errors  those of find_scenes()
Result<std::vector<std::filesystem::path>> find_scenes_of(const std::vector<std::string>& names,
                                                          std::vector<SceneGroup>& groups);

}  // namespace duo
