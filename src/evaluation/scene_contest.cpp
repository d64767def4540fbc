#include "duoptic/scene_contest.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <set>

#include "core/clock.h"
#include "duoptic/row_offsets.h"

namespace duo {
namespace {

namespace fs = std::filesystem;

/// Wall time.
template <class F>
double call_ms(F&& call) {
  const std::int64_t begin_ns = wall_ns();
  call();
  return static_cast<double>(wall_ns() - begin_ns) * 1e-6;
}

Result<Image<float>> match(const StereoScene& scene, const SceneMatcher& ours, const std::function<void(double)>& progress,
                           double& ms) {
  DUO_TRY_ASSIGN(const auto engine, make_engine(ours.engine, ours.threads));
  Setup setup = ours.setup;
  setup.progress = progress;
  setup.size = scene.pair.left.pixels.size();
  setup.max_disparity = scene.max_disparity;
  if (!ours.keep_rows) {
    const RowOffsets rows = find_row_offsets(scene.pair, ours.threads);
    if (rows.matter()) setup.rows = rows;
  }
  DUO_TRY(engine->prepare(setup));
  std::shared_ptr<const Frame> frame;
  const auto once = [&] {
    engine->submit(scene.pair);
    frame = engine->collect();
  };
  once();  // warm caches
  ms = call_ms(once);
  return disparity_as_px(frame->disparity.d_q4);
}

SceneScore score_peer(const Peer& peer, const StereoScene& scene, int threads) {
  PeerMatcher matcher(peer, opencv_gray(scene.pair.left.pixels), opencv_gray(scene.pair.right.pixels), scene.max_disparity);
  matcher.run(threads);
  const double ms = call_ms([&] { matcher.run(threads); });
  return {scene.name, score_disparity(matcher.disparity_px(), scene), ms};
}

double mean_percent(const std::vector<SceneScore>& scenes, BadPercent DisparityScore::*bad, std::size_t threshold) {
  double sum = 0;
  for (const SceneScore& s : scenes)
    for (double p : (s.score.*bad)[threshold]) sum += p;
  return sum / static_cast<double>(3 * scenes.size());
}

}  // namespace

const std::map<std::string, std::array<double, 3>>& thesis_percent() {
  static const std::map<std::string, std::array<double, 3>> kThesis = {{"tsukuba", {33.2, 32.4, 27.6}},
                                                                       {"venus", {32.3, 32.3, 26.0}},
                                                                       {"teddy", {34.7, 34.6, 34.7}},
                                                                       {"cones", {34.4, 34.3, 33.8}}};
  return kThesis;
}

double MethodScores::filled_percent(std::size_t threshold) const {
  return mean_percent(scenes, &DisparityScore::bad_filled, threshold);
}
double MethodScores::holes_bad_percent(std::size_t threshold) const {
  return mean_percent(scenes, &DisparityScore::bad_holes, threshold);
}

MethodScores MethodScores::part(std::size_t begin, std::size_t end) const {
  const auto at = [&](std::size_t i) { return scenes.begin() + static_cast<std::ptrdiff_t>(i); };
  return {method, {at(begin), at(end)}};
}

MethodScores MethodScores::v2() const {
  MethodScores out{method, {}};
  for (const SceneScore& s : scenes)
    if (thesis_percent().contains(s.scene)) out.scenes.push_back(s);
  return out;
}

bool MethodScores::has_v2() const {
  const std::vector<SceneScore> of_v2 = v2().scenes;
  std::set<std::string> names;
  for (const SceneScore& s : of_v2) names.insert(s.scene);
  return names.size() == thesis_percent().size() && of_v2.size() == names.size();
}

std::vector<MethodScores> methods_of(const SceneContest& contest) {
  std::vector<MethodScores> out;
  for (const SceneMatcher& ours : contest.ours) out.push_back({ours.name, {}});
  for (const Peer& peer : contest.peers) out.push_back({fmt::format("OpenCV {}", peer.name), {}});
  return out;
}

Result<Image<float>> add_scene(const SceneContest& contest, const StereoScene& scene, std::vector<MethodScores>& methods,
                               const std::function<void(double)>& progress) {
  Image<float> first_px;
  for (std::size_t i = 0; i < contest.ours.size(); ++i) {
    double ms = 0;
    DUO_TRY_ASSIGN(Image<float> found_px, match(scene, contest.ours[i], progress, ms));
    methods[i].scenes.push_back({scene.name, score_disparity(found_px, scene), ms});
    if (i == 0) first_px = std::move(found_px);
  }
  for (std::size_t i = 0; i < contest.peers.size(); ++i)
    methods[contest.ours.size() + i].scenes.push_back(score_peer(contest.peers[i], scene, contest.threads));
  return first_px;
}

StereoScene perturb(const StereoScene& scene, const Perturbation& how) {
  StereoScene worse{scene.name, perturb(scene.pair, how), scene.max_disparity, scene.truth_px.clone(), {}};
  worse.regions = {scene.regions.all.clone(), scene.regions.nonocc.clone(), scene.regions.disc.clone()};
  return worse;
}

Image<Rgb8> draw_errors(const Image<float>& d_px, const StereoScene& scene) {
  Image<Rgb8> out(d_px.size());
  for (int y = 0; y < out.height(); ++y)
    for (int x = 0; x < out.width(); ++x) {
      if (scene.regions.all.at(y, x) == 0) out.at(y, x) = {64, 64, 96};
      if (scene.regions.all.at(y, x) == 0 || d_px.at(y, x) < 0) continue;
      const float error = std::abs(d_px.at(y, x) - scene.truth_px.at(y, x));
      const auto gray = static_cast<std::uint8_t>(255 - 100 * std::min(error, 1.0f));
      const Rgb8 wrong = scene.regions.nonocc.at(y, x) != 0 ? Rgb8{220, 40, 40} : Rgb8{60, 90, 220};
      out.at(y, x) = error <= 1.0f ? Rgb8{gray, gray, gray} : wrong;
    }
  return out;
}

Result<std::vector<fs::path>> find_scenes_of(const std::vector<std::string>& names, std::vector<SceneGroup>& groups) {
  std::vector<fs::path> all;
  for (const std::string& name : names) {
    DUO_TRY_ASSIGN(const auto found, find_scenes({fs::path(name)}));
    if (found.size() > 1) {
      std::error_code failed;
      const fs::path whole = fs::weakly_canonical(name, failed);
      groups.push_back({failed ? name : whole.filename().string(), all.size(), all.size() + found.size()});
    }
    all.insert(all.end(), found.begin(), found.end());
  }
  if (names.size() == 1) groups.clear();
  return all;
}

}  // namespace duo
