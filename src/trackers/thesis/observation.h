// What the thesis tracker expects in a frame, and what is seen of it: plain numbers, a few kB, that travel to and from a
// device.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "duoptic/frame.h"
#include "stages/mark_targets/mark_targets.h"
#include "stages/sums/sums.h"
#include "stages/types/sift_points.h"

namespace duo {

/// A place in the rectified left picture.
///
/// Units   1/16 px; centres of pixels are multiples of 16
struct PlaceQ4 {
  std::int32_t x = 0, y = 0;
  friend bool operator==(const PlaceQ4&, const PlaceQ4&) = default;

  Pixel pixel() const { return {(y + 8) >> 4, (x + 8) >> 4}; }  // the nearest; y, x > -2^27
};

/// Points stored around a joint, and the way from each to the joint.
struct JointPoints {
  static constexpr int kCapacity = 256;  // a textured window of 107 px gives about 100
  SiftPoints points;
  std::vector<PlaceQ4> to_joint;  // one a point
};

/// A joint before it is observed: its colour and window, its place in the last frame.
struct ExpectedJoint {
  Target target;
  PlaceQ4 at;
};
/// Windows are not larger than joint_window_px() along both sides.
struct Expectation {
  std::array<ExpectedJoint, kMaxTargets> joints;
  int count = 0;
  std::shared_ptr<const std::vector<JointPoints>> points;  // one a joint; others lie at another address
};

inline int joint_window_px(Size size) { return size.width / 6; }  // 107 of 640: a fast hand's way in a few frames

enum SeenBy : std::uint32_t { kSeenByColor = 1, kSeenByPoints = 2 };

/// A joint as it was seen: half way between its colour's and its points' opinion; where it was expected if there was neither.
struct ObservedJoint {
  PlaceQ4 at;
  std::uint32_t seen_by = 0;              // SeenBy
  std::uint32_t d_q4 = Disparity::kNone;  // at that place, 1/16 px
  friend bool operator==(const ObservedJoint&, const ObservedJoint&) = default;
};
struct Observation {
  std::array<AreaSums, kMaxTargets> colors;  // the region of each joint's colour
  std::array<ObservedJoint, kMaxTargets> joints;
  std::array<StageTime, 12> stages{};  // as in Frame
};

}  // namespace duo
