// An arm as an animator's skeleton has it: two bones that turn from a T-pose.
#pragma once

#include <array>
#include <optional>
#include <string_view>

#include "duoptic/geometry.h"
#include "duoptic/sink.h"

namespace duo {

/// Axes of a person who stands in a T-pose and looks along z, y up: how far the arm's rest points along x. +1 or -1.
double rest_x(ArmSide side, bool left_handed);

/// The side of arm number `arm` of a recording.
ArmSide side_of(ArmSide first, std::size_t arm);
std::string_view side_name(ArmSide side);  // "Left", "Right"

/// Turns of both bones, in the parent's axes; a bone at rest points along (rest_x, 0, 0), and its elbow bends towards +z.
struct BoneTurns {
  Mat3 upper;  // shoulder to elbow; the parent stands still
  Mat3 lower;  // elbow to hand; the parent is the upper bone
};

/// Finds the turns of one arm, frame after frame. Two directions leave open how the upper arm is twisted: it is so that the
/// elbow bends around its own hinge, as elbows do; of a straight arm, whose hinge cannot be seen, as it was last.
class ArmTurner {
 public:
  explicit ArmTurner(double rest_x) : rest_x_(rest_x) {}
  /// Units  any; only directions count. Empty when two joints coincide.
  std::optional<BoneTurns> turn(Vec3 shoulder, Vec3 elbow, Vec3 hand);

 private:
  double rest_x_;
  Vec3 hinge_{0, 1, 0};  // in the parent's axes
};

/// The same turn as a quaternion x y z w of length 1, w >= 0.
std::array<double, 4> quaternion(const Mat3& rotation);

}  // namespace duo
