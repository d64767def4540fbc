// A person at one instant: an identity and an estimate per joint of a skeleton. A plain value: copying allocates nothing.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <type_traits>

#include "duoptic/geometry.h"
#include "duoptic/skeleton.h"
#include "duoptic/window.h"

namespace [[gnu::visibility("default")]] duo {

/// Covariance of a position.
///
/// Units  m², rig frame
struct Covariance3 {
  double xx = 0, xy = 0, xz = 0, yy = 0, yz = 0, zz = 0;

  /// One standard deviation of the distance from the truth: the root of the trace.
  double sigma_m() const { return std::sqrt(xx + yy + zz); }
  /// The same in every direction, with the given sigma_m(), to the last bit.
  static Covariance3 isotropic(double sigma_m) {
    const double trace = sigma_m * sigma_m, third = trace / 3;
    return {third, 0, 0, third, 0, trace - 2 * third};  // the rest, not a third: the sum must not be rounded
  }
};

/// A rotation as a quaternion of length 1.
struct Quaternion {
  float x = 0, y = 0, z = 0, w = 1;
};

enum class JointState : std::uint8_t {
  kSeen,      // measured in this frame
  kInferred,  // hidden: predicted from what is known of the body; the covariance grows with time
  kLost,      // could be anywhere in reach; the position is a guess, on which files of motion fall back
};

/// One joint at one instant.
///
/// Units  p_in_rig_m: the joint's centre inside the body, metres in the rig frame; v_in_rig_m_s: its velocity; rig_from_bone:
///        turn of the bone that ends in the joint, when has_turn; confidence 0 .. 1; u_px, v_px: where the joint projects in
///        the raw left picture
struct Joint {
  Vec3 p_in_rig_m = {};
  Covariance3 cov_m2 = {};
  Vec3 v_in_rig_m_s = {};
  Quaternion rig_from_bone = {};
  bool has_turn = false;
  JointState state = JointState::kLost;
  double confidence = 0;
  double u_px = 0, v_px = 0;

  double sigma_m() const { return cov_m2.sigma_m(); }
};

enum class Presence : std::uint8_t {
  kSeen,    // a joint was measured in this frame
  kHidden,  // no joint was measured; where the joints are is inferred
  kLost,    // every joint is lost
};

/// Shape  the first skeleton->joints.size() of `joints` are the skeleton's, in its order; the others mean nothing
/// Units  confidence 0 .. 1; box_px: around the joints that are not lost, raw left picture
struct Person {
  std::uint32_t id = 0;  // from 1; the same person has the same id while it is tracked
  const Skeleton* skeleton = nullptr;
  Presence presence = Presence::kLost;
  double confidence = 0;
  Window box_px = {};
  std::array<Joint, Skeleton::kMostJoints> joints = {};

  std::size_t count() const { return skeleton == nullptr ? 0 : skeleton->joints.size(); }
  /// Null when the skeleton lacks the joint.
  const Joint* find(JointId id) const;
  /// Sets presence, confidence and box_px to what the joints say: the surest state, the mean confidence, the box around them.
  void sum_up();
};
static_assert(std::is_trivially_copyable_v<Person>);

/// How far the tips of a hand's thumb and index finger are apart.
///
/// Units  metres; sigma_m: one standard deviation along the line between them, the errors of both taken as independent
struct Pinch {
  double distance_m = 0, sigma_m = 0;
};
/// None where a tip is lost, where neither is seen, and where the skeleton has no fingers. `side`: left or right.
std::optional<Pinch> pinch_of(const Person& person, Side side);

}  // namespace duo
