// A clip with exact joints and depth: two videos, their rig, and truth.json (see ClipTruth for what is read of it).
#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "duoptic/frame.h"
#include "duoptic/result.h"
#include "duoptic/rig.h"
#include "duoptic/skeleton.h"

namespace duo::app {

struct JointTruth {
  Vec3 p_in_left_m;           // the joint's centre, in the raw left camera's axes
  double u_px = 0, v_px = 0;  // where it projects in the raw left picture, whether it is seen there or not
  bool visible = false;       // in both pictures, nothing in front of it
};
/// Of the joints that a frame's truth has; by JointId.
using FrameTruth = std::array<std::optional<JointTruth>, kJointIds>;

/// Of truth.json: meta.selected_arm ("left" or "right"), meta.skew_ms (0 where there is none), frames[i].joints.NAME.{xyz,
/// uv_left, vis_left, vis_right}. Names that no skeleton has are passed over.
struct ClipTruth {
  std::string name;
  Rig rig;
  Side arm = Side::kRight;  // the arm that moves
  double skew_ms = 0;       // how much later the right pictures were taken
  std::vector<FrameTruth> frames;

  /// Errors  a frame lacks the joint
  Result<void> check(JointId joint) const;
  /// The first frame in which the cameras see all these joints.
  ///
  /// Errors  there is none
  Result<std::int64_t> first_visible(std::span<const JointId> joints) const;
};

/// Reads calibration_truth.yml and truth.json.
///
/// Errors  one of them is missing or holds something else
Result<ClipTruth> load_clip(const std::filesystem::path& folder);

/// Depth of one frame on the person.
struct DepthTruth {
  Image<std::uint16_t> z_tenth_mm;  // z in 0.1 mm, 0 = none, of a pinhole camera in the left camera's place
  Image<std::uint8_t> figure;       // 255 on the person
};

/// depth/depth_NNNN.png and depth/figure_NNNN.png; empty pictures when this frame has none.
///
/// Errors  they are there and are no such pictures
Result<DepthTruth> load_depth(const std::filesystem::path& folder, std::int64_t frame);

}  // namespace duo::app
