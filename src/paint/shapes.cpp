// Persons as shapes over the raw left picture, and in words.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "duoptic/paint.h"

namespace duo {
namespace {

/// A box as wide as a hand, a ring of one sigma.
Shapes::Mark mark_of(const Joint& joint, const TrackHeader& header) {
  constexpr double kHalf_m = 0.05, kNearest_m = 0.1;
  const double px_per_m = header.rectified.focal_px / std::max(joint.p_in_rig_m.z, kNearest_m);
  const double width = header.size.width;
  return {joint.u_px, joint.v_px, std::clamp(kHalf_m * px_per_m, width / 128, width / 10),
          std::clamp(joint.sigma_m() * px_per_m, width / 200, 3 * width), joint.state != JointState::kSeen};
}

/// Whether a joint is the centre of a palm whose fingers are known, which show the hand better than a box.
bool has_fingers(const Person& person, JointId id) {
  if (id != JointId::kLeftHand && id != JointId::kRightHand) return false;
  const Joint* root = person.find(id == JointId::kLeftHand ? JointId::kLeftMiddleMcp : JointId::kRightMiddleMcp);
  return root != nullptr && root->state != JointState::kLost;
}

}  // namespace

Shapes shapes_of(std::span<const Person> people, const TrackHeader& header) {
  Shapes out;
  for (const Person& person : people)
    for (std::size_t j = 0; j < person.count(); ++j) {
      const Joint& joint = person.joints[j];
      if (joint.state == JointState::kLost) continue;
      const JointId id = person.skeleton->joints[j].id;
      const bool finger = is_finger(id);
      if (!finger && !has_fingers(person, id)) out.joints.push_back(mark_of(joint, header));
      const int parent = person.skeleton->joints[j].parent;
      if (parent < 0) continue;
      const Joint& from = person.joints[static_cast<std::size_t>(parent)];
      if (from.state == JointState::kLost) continue;
      const bool broken = from.state != JointState::kSeen || joint.state != JointState::kSeen;
      out.bones.push_back({from.u_px, from.v_px, joint.u_px, joint.v_px, broken, finger});
    }
  return out;
}

std::vector<Label> labels_of(const Person& person, bool metric) {
  constexpr std::size_t kMost = 4;
  std::vector<Label> out;
  if (person.count() > kMost) {
    std::size_t seen = 0;
    for (std::size_t j = 0; j < person.count(); ++j) seen += person.joints[j].state == JointState::kSeen;
    out.push_back({fmt::format("person {}: {} of {} joints seen", person.id, seen, person.count()), "",
                   static_cast<JointState>(person.presence)});
    for (const Side side : {Side::kLeft, Side::kRight})
      if (const auto pinch = pinch_of(person, side); pinch && metric)
        out.push_back({fmt::format("{} pinch {:.1f}", side == Side::kLeft ? "left" : "right", 100 * pinch->distance_m),
                       fmt::format("{:.1f} cm", 100 * pinch->sigma_m), JointState::kSeen});
    return out;
  }
  for (std::size_t j = person.count(); j-- > 0;) {
    const Joint& joint = person.joints[j];
    const std::string_view part = part_of(person.skeleton->joints[j].id);
    if (joint.state == JointState::kLost)
      out.push_back({fmt::format("{} lost", part), "", joint.state});
    else
      out.push_back({fmt::format("{} {:.2f}{}", part, joint.p_in_rig_m.z, metric ? " m" : ""),
                     metric ? fmt::format("{:.0f} cm", std::ceil(100 * joint.sigma_m())) : "", joint.state});
  }
  return out;
}

std::vector<JointId> shaded_joints(const TrackHeader& header) {
  std::vector<JointId> out;
  for (const Skeleton* skeleton : header.skeletons)
    for (const JointDef& joint : skeleton->joints) {
      if (is_finger(joint.id)) continue;  // its shade is the hand's
      const auto same = [&](JointId other) { return part_of(other) == part_of(joint.id); };
      if (std::none_of(out.begin(), out.end(), same)) out.push_back(joint.id);
    }
  return out;
}

std::vector<ShadeKey> shade_keys(const TrackHeader& header) {
  constexpr std::size_t kMostNames = 4;
  const auto limb_of = [](JointId joint) {
    return joint < JointId::kLeftShoulder ? "trunk" : joint < JointId::kLeftHip ? "arm" : "leg";
  };
  const std::vector<JointId> joints = shaded_joints(header);
  std::vector<ShadeKey> out;
  for (const JointId joint : joints) {
    const std::string name(joints.size() > kMostNames ? limb_of(joint) : part_of(joint));
    if (out.empty() || out.back().name != name) out.push_back({name, {}});
    out.back().joints.push_back(joint);
  }
  return out;
}

}  // namespace duo
