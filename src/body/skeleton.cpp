#include "duoptic/skeleton.h"

#include <algorithm>
#include <array>

namespace duo {
namespace {

using enum JointId;

constexpr std::array<JointDef, kBodyJointIds> kBodyJoints = {{
    {kPelvis, "pelvis", -1, Side::kMiddle, 0.15},
    {kSpine, "spine", 0, Side::kMiddle, 0.15},
    {kChest, "chest", 1, Side::kMiddle, 0.16},
    {kNeck, "neck", 2, Side::kMiddle, 0.08},
    {kHead, "head", 3, Side::kMiddle, 0.13},
    {kLeftShoulder, "left_shoulder", 2, Side::kLeft, 0.11},
    {kLeftElbow, "left_elbow", 5, Side::kLeft, 0.075},
    {kLeftWrist, "left_wrist", 6, Side::kLeft, 0.06},
    {kLeftHand, "left_hand", 7, Side::kLeft, 0.11},
    {kRightShoulder, "right_shoulder", 2, Side::kRight, 0.11},
    {kRightElbow, "right_elbow", 9, Side::kRight, 0.075},
    {kRightWrist, "right_wrist", 10, Side::kRight, 0.06},
    {kRightHand, "right_hand", 11, Side::kRight, 0.11},
    {kLeftHip, "left_hip", 0, Side::kLeft, 0.13},
    {kLeftKnee, "left_knee", 13, Side::kLeft, 0.09},
    {kLeftAnkle, "left_ankle", 14, Side::kLeft, 0.07},
    {kLeftFoot, "left_foot", 15, Side::kLeft, 0.09},
    {kRightHip, "right_hip", 0, Side::kRight, 0.13},
    {kRightKnee, "right_knee", 17, Side::kRight, 0.09},
    {kRightAnkle, "right_ankle", 18, Side::kRight, 0.07},
    {kRightFoot, "right_foot", 19, Side::kRight, 0.09},
}};

// By name, the left hand's and the right one's; the fingers' roots hang on the wrist.
constexpr std::array<std::string_view, 2 * kFingerJoints> kFingerNames = {
    "left_thumb_cmc",   "left_thumb_mcp",   "left_thumb_ip",   "left_thumb_tip",  "left_index_mcp",   "left_index_pip",
    "left_index_dip",   "left_index_tip",   "left_middle_mcp", "left_middle_pip", "left_middle_dip",  "left_middle_tip",
    "left_ring_mcp",    "left_ring_pip",    "left_ring_dip",   "left_ring_tip",   "left_pinky_mcp",   "left_pinky_pip",
    "left_pinky_dip",   "left_pinky_tip",   "right_thumb_cmc", "right_thumb_mcp", "right_thumb_ip",   "right_thumb_tip",
    "right_index_mcp",  "right_index_pip",  "right_index_dip", "right_index_tip", "right_middle_mcp", "right_middle_pip",
    "right_middle_dip", "right_middle_tip", "right_ring_mcp",  "right_ring_pip",  "right_ring_dip",   "right_ring_tip",
    "right_pinky_mcp",  "right_pinky_pip",  "right_pinky_dip", "right_pinky_tip"};

constexpr std::array<JointDef, kJointIds> with_fingers() {
  constexpr double kRadius_m = 0.014;
  std::array<JointDef, kJointIds> out = {};
  std::copy(kBodyJoints.begin(), kBodyJoints.end(), out.begin());
  for (std::size_t i = 0; i < kFingerNames.size(); ++i) {
    const std::size_t at = kBodyJointIds + i;
    const bool left = i < kFingerJoints, root = finger_of(static_cast<JointId>(at)).joint == 0;
    const std::size_t parent = root ? static_cast<std::size_t>(left ? kLeftWrist : kRightWrist) : at - 1;
    out[at] = {static_cast<JointId>(at), kFingerNames[i], static_cast<std::int8_t>(parent), left ? Side::kLeft : Side::kRight,
               kRadius_m};
  }
  return out;
}
constexpr auto kAllJoints = with_fingers();

/// A chain of joints out of the body's: each is the next one's parent.
constexpr std::array<JointDef, 3> chain(JointId root, JointId middle, JointId end) {
  std::array<JointDef, 3> out = {kBodyJoints[static_cast<std::size_t>(root)], kBodyJoints[static_cast<std::size_t>(middle)],
                                 kBodyJoints[static_cast<std::size_t>(end)]};
  for (std::size_t i = 0; i < out.size(); ++i) out[i].parent = static_cast<std::int8_t>(static_cast<int>(i) - 1);
  return out;
}
constexpr auto kRightArmJoints = chain(kRightShoulder, kRightElbow, kRightHand);
constexpr auto kLeftArmJoints = chain(kLeftShoulder, kLeftElbow, kLeftHand);

/// Parents come first, and a name stands where its id says.
constexpr bool in_order() {
  for (std::size_t i = 0; i < kJointIds; ++i)
    if (static_cast<std::size_t>(kAllJoints[i].id) != i || kAllJoints[i].parent >= static_cast<int>(i)) return false;
  return true;
}
static_assert(in_order());

}  // namespace

constinit const Skeleton kBody = {"body", kBodyJoints};
constinit const Skeleton kBodyHands = {"body_hands", kAllJoints};
constinit const Skeleton kRightArm = {"right_arm", kRightArmJoints};
constinit const Skeleton kLeftArm = {"left_arm", kLeftArmJoints};

std::optional<std::size_t> Skeleton::index_of(JointId id) const {
  for (std::size_t i = 0; i < joints.size(); ++i)
    if (joints[i].id == id) return i;
  return std::nullopt;
}

const Skeleton* skeleton_named(std::string_view name) {
  for (const Skeleton* skeleton : {&kBody, &kBodyHands, &kRightArm, &kLeftArm})
    if (skeleton->name == name) return skeleton;
  return nullptr;
}

std::optional<JointId> joint_named(std::string_view name) {
  const auto found = std::find_if(kAllJoints.begin(), kAllJoints.end(), [&](const JointDef& j) { return j.name == name; });
  if (found == kAllJoints.end()) return std::nullopt;
  return found->id;
}

std::string_view name_of(JointId id) { return kAllJoints[static_cast<std::size_t>(id)].name; }

std::string_view part_of(JointId id) {
  const JointDef& joint = kAllJoints[static_cast<std::size_t>(id)];
  return joint.side == Side::kMiddle ? joint.name : joint.name.substr(joint.name.find('_') + 1);
}

}  // namespace duo
