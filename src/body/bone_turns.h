// A skeleton as an animator has it: bones that turn from a T-pose.
#pragma once

#include <array>
#include <optional>
#include <span>
#include <vector>

#include "duoptic/geometry.h"
#include "duoptic/person.h"
#include "duoptic/skeleton.h"

namespace duo {

/// Axes of a person who stands in a T-pose and looks along z, y up.
enum class BodyAxes : std::uint8_t {
  kRightHanded,  // the person's left is +x: BVH
  kLeftHanded,   // the person's left is -x: Unity
};

/// Where the bone that ends in a joint points in the T-pose; its parent's joint is where it begins. Length 1.
Vec3 rest_direction(JointId joint, BodyAxes axes);

/// The places of a person's joints in the order of its skeleton; empty while one of them is lost. Of a whole body limbs may be
/// lost, as legs below the picture are: they hang from the trunk, as long as an adult's.
///
/// Units  metres
std::optional<std::vector<Vec3>> known_places(const Person& person, const Mat3& axes_from_rig);

/// Finds how the bones of one person turn, frame after frame.
///
/// Joints with several bones below them turn so that these fit best; one with a single bone turns so that it fits, by the
/// smallest turn. Two directions leave open how the upper bone of a limb is twisted: it is so that elbow or knee bends around
/// its own hinge, as they do; of a straight limb, whose hinge cannot be seen, as it was last.
///
/// Source  several bones: Kabsch, "A solution for the best rotation to relate two sets of vectors", 1976
class BoneTurner {
 public:
  BoneTurner(const Skeleton& skeleton, BodyAxes axes);

  /// The turn of each joint in its parent's axes, in the order of the skeleton; the root's in those of the places. A joint that
  /// no bone begins at does not turn.
  ///
  /// With `lengths`, of the bone that ends in each joint, bones that are not as long as the places are apart do not leave the
  /// places behind: each is turned from where the bones before it lead to where it should end.
  ///
  /// Units  of places and lengths the same; without lengths only directions count. Empty when two joints of a bone coincide.
  std::optional<std::vector<Mat3>> turn(std::span<const Vec3> places, std::span<const double> lengths = {});

 private:
  struct Node {
    std::vector<std::size_t> children;
    Vec3 rest;             // of the bone that ends here
    Vec3 hinge_at_rest;    // the axis that the bone below keeps, across its rest direction
    bool bends = false;    // the upper bone of a limb
    double bend_sign = 1;  // cross(upper, lower) points along the hinge when it bends as it can
    Vec3 hinge;            // of the limb, as it was last, in the parent's axes
  };
  Mat3 turn_of(Node& node, std::span<const Vec3> bones_in_parent, std::span<const Vec3> rest, const Mat3& rig_from_parent,
               std::span<const Vec3> places);

  std::vector<Node> nodes_;
};

/// The same turn as a quaternion x y z w of length 1, w >= 0.
std::array<double, 4> quaternion(const Mat3& rotation);

}  // namespace duo
