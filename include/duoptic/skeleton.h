// A skeleton: a constant table of joints. Whatever walks the table works for every skeleton.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

namespace [[gnu::visibility("default")]] duo {

/// The person's own side.
enum class Side : std::uint8_t { kMiddle, kLeft, kRight };

/// Every joint that a skeleton may have. The numbers are stable: files and protocols carry them.
enum class JointId : std::uint8_t {
  kPelvis,
  kSpine,
  kChest,
  kNeck,
  kHead,
  kLeftShoulder,
  kLeftElbow,
  kLeftWrist,
  kLeftHand,
  kRightShoulder,
  kRightElbow,
  kRightWrist,
  kRightHand,
  kLeftHip,
  kLeftKnee,
  kLeftAnkle,
  kLeftFoot,
  kRightHip,
  kRightKnee,
  kRightAnkle,
  kRightFoot,
  // Fingers, from their roots to their tips.
  kLeftThumbCmc,
  kLeftThumbMcp,
  kLeftThumbIp,
  kLeftThumbTip,
  kLeftIndexMcp,
  kLeftIndexPip,
  kLeftIndexDip,
  kLeftIndexTip,
  kLeftMiddleMcp,
  kLeftMiddlePip,
  kLeftMiddleDip,
  kLeftMiddleTip,
  kLeftRingMcp,
  kLeftRingPip,
  kLeftRingDip,
  kLeftRingTip,
  kLeftPinkyMcp,
  kLeftPinkyPip,
  kLeftPinkyDip,
  kLeftPinkyTip,
  kRightThumbCmc,
  kRightThumbMcp,
  kRightThumbIp,
  kRightThumbTip,
  kRightIndexMcp,
  kRightIndexPip,
  kRightIndexDip,
  kRightIndexTip,
  kRightMiddleMcp,
  kRightMiddlePip,
  kRightMiddleDip,
  kRightMiddleTip,
  kRightRingMcp,
  kRightRingPip,
  kRightRingDip,
  kRightRingTip,
  kRightPinkyMcp,
  kRightPinkyPip,
  kRightPinkyDip,
  kRightPinkyTip,
};
inline constexpr std::size_t kBodyJointIds = 21;  // those before the fingers
inline constexpr std::size_t kFingers = 5;        // of one hand, the thumb first
inline constexpr std::size_t kJointsPerFinger = 4;
inline constexpr std::size_t kFingerJoints = kFingers * kJointsPerFinger;  // of one hand
inline constexpr std::size_t kJointIds = kBodyJointIds + 2 * kFingerJoints;

constexpr bool is_finger(JointId id) { return static_cast<std::size_t>(id) >= kBodyJointIds; }

/// One joint of a skeleton.
struct JointDef {
  JointId id;
  std::string_view name;  // "left_hand"
  std::int8_t parent;     // index in the same skeleton, which is smaller than the joint's own; -1: the root
  Side side;
  double radius_m;  // from the joint to the skin and a little more, of an adult
};

/// Joints, parents first.
struct Skeleton {
  static constexpr std::size_t kMostJoints = 64;
  std::string_view name;
  std::span<const JointDef> joints;

  /// The index of a joint in `joints`; none when the skeleton lacks it.
  std::optional<std::size_t> index_of(JointId id) const;
};

extern const Skeleton kBody;       // "body": every joint but those of fingers
extern const Skeleton kBodyHands;  // "body_hands": every joint; the body's come first, as in "body"
extern const Skeleton kRightArm;   // "right_arm": right_shoulder, right_elbow, right_hand
extern const Skeleton kLeftArm;    // "left_arm"

/// Which finger, the thumb first, and which of its joints, its root first.
struct FingerJoint {
  std::size_t finger, joint;
};

/// Where a finger's joint is in its hand. Of other joints it means nothing.
constexpr FingerJoint finger_of(JointId id) {
  const std::size_t in_hand = (static_cast<std::size_t>(id) - kBodyJointIds) % kFingerJoints;
  return {in_hand / kJointsPerFinger, in_hand % kJointsPerFinger};
}

/// The joint at that place of a hand; `side`: left or right.
constexpr JointId finger_joint(Side side, FingerJoint at) {
  return static_cast<JointId>(kBodyJointIds + (side == Side::kRight ? kFingerJoints : 0) + at.finger * kJointsPerFinger +
                              at.joint);
}

/// The skeleton of that name; null when there is none.
const Skeleton* skeleton_named(std::string_view name);

/// The joint of that name; none when there is none.
std::optional<JointId> joint_named(std::string_view name);
std::string_view name_of(JointId id);
/// The name without its side: "hand".
std::string_view part_of(JointId id);

}  // namespace duo
