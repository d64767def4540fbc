// All that a frame and the frames before say of one person, before joints are chosen.
#pragma once

#include <optional>
#include <span>

#include "trackers/body/lengths.h"
#include "trackers/body/lift.h"
#include "trackers/body/points.h"
#include "trackers/body/surface_map.h"

namespace duo::body {

/// Where a joint is expected.
struct Expected {
  Vec3 p;
  double sigma_m = 0.1;
  double hidden = 0;  // ticks since it was seen
};

/// What the network of hands said in this frame or, where the other hand was asked, in the one before; outside: the hand would
/// be beyond the picture's border.
enum class HandSight : std::uint8_t { kNotAsked, kSeen, kAbsent, kOutside };

struct Scene {
  DepthView depth;
  Points points;
  PerJoint<Surfaces> surfaces;
  PerJoint<Expected> expected;
  Across across;                        // by the network
  std::array<HandSight, 2> hands = {};  // left, right
  std::array<double, 2> lifted = {};    // as lifted() has it: left, right
  const Lengths* lengths = nullptr;
  const SurfaceMap* map = nullptr;
  std::span<const Places* const> nearer;  // people before this one, as fitted in this frame
  TrunkAxes trunk;                        // as expected; chosen anew with the shoulders and hips
  double trunk_z_m = 0;

  /// From the shoulders' middle back to where it is while both arms hang.
  Vec3 lift_m() const { return (0.5 * kLift * width_m() * (lifted[0] + lifted[1])) * trunk.down; }
  double width_m() const { return (*lengths)[Bone::kShoulders]; }
  HandSight sight_of(JointId hand_or_wrist) const { return hands[is_left(hand_or_wrist) ? 0 : 1]; }
  /// How far a wrist or hand is behind where it would lie on the back, m. None where it is not behind the trunk, where its
  /// network sees it or did not look, or where the trunk does not face the cameras. In behind_back.cpp.
  std::optional<double> off_back_m(JointId id, Vec3 p) const;
  /// How far a joint of an arm is outwards from where it would hang, across the trunk, m; `shoulder` is its own. None but of
  /// the arm that the trunk hides from the side, and of the shoulder. In behind_back.cpp.
  std::optional<double> off_hanging_m(JointId id, Vec3 p, Vec3 shoulder) const;
};

/// From the skin to the joint along the view. `away`: how far the joint's side of the trunk looks away from the camera, -1
/// .. 1.
double depth_of_joint_m(JointId id, double width_m, double away);
/// The same for a joint of this scene, by the network's line across the trunk.
double depth_of_joint_m(const Scene& scene, JointId id, double skin_z_m);

/// Half the window that depth is read in.
double half_window_m(JointId id);

}  // namespace duo::body
