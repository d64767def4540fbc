// A Middlebury scene: a rectified pair, its true disparity, and the regions in which the evaluation counts.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "duoptic/frame.h"
#include "duoptic/result.h"

namespace duo::app {

/// Where the evaluation counts; 255 inside a region, 0 outside.
///
/// Shape   all H x W of the left picture
struct Regions {
  Image<std::uint8_t> all;     // truth known, outside the border that the scene leaves out
  Image<std::uint8_t> nonocc;  // of these, seen by both cameras
  Image<std::uint8_t> disc;    // of these, near a depth discontinuity
};

struct Scene {
  std::string name;
  Pair pair;
  int max_disparity = 0;  // search [0, max_disparity) px
  Image<float> truth_px;  // 0 = unknown
  Regions regions;
};

/// The scene folders that `paths` stand for: a folder with meta.json is a scene, any other folder holds scenes.
///
/// Errors  not a folder; no scene inside
Result<std::vector<std::filesystem::path>> find_scenes(const std::vector<std::filesystem::path>& paths);

/// Reads left.png, right.png, disp_left.png, the official masks where there are any, and meta.json.
Result<Scene> load_scene(const std::filesystem::path& folder);

/// The regions of the Middlebury evaluation worked out from the truth alone, for scenes without official masks. Against the
/// official masks of teddy and cones 1 % of nonocc and 6 to 8 % of disc differ.
///
/// Source  after Scharstein and Szeliski, "A taxonomy and evaluation of dense two-frame stereo correspondence algorithms",
///         2002, 5.1: occluded = something nearer lands on the same pixel of the right view; discontinuity = within half a
///         9x9 window of a jump of 2 px or of a pixel that is occluded or unknown
Regions derive_regions(const Image<float>& truth_px, int border_px);

}  // namespace duo::app
