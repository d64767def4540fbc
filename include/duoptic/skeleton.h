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
};
inline constexpr std::size_t kJointIds = 21;

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
  static constexpr std::size_t kMostJoints = 32;
  std::string_view name;
  std::span<const JointDef> joints;

  /// The index of a joint in `joints`; none when the skeleton lacks it.
  std::optional<std::size_t> index_of(JointId id) const;
};

extern const Skeleton kBody;      // "body": every joint
extern const Skeleton kRightArm;  // "right_arm": right_shoulder, right_elbow, right_hand
extern const Skeleton kLeftArm;   // "left_arm"

/// The skeleton of that name; null when there is none.
const Skeleton* skeleton_named(std::string_view name);

/// The joint of that name; none when there is none.
std::optional<JointId> joint_named(std::string_view name);
std::string_view name_of(JointId id);
/// The name without its side: "hand".
std::string_view part_of(JointId id);

}  // namespace duo
