#include <algorithm>
#include <cmath>
#include <vector>

#include "core/check.h"
#include "core/point.h"
#include "duoptic/paint.h"

namespace duo {
namespace {

/// A piece of a person between a joint and its parent, or around a joint without one.
struct Bone {
  const JointDef *from, *to;
  Vec3 start_in_rig_m, along_m;
  double inverse_length2;  // 1/m², 0 for a single joint
  double wide;             // times the joints' radii
};

std::vector<Bone> bones_of(std::span<const Person> people) {
  std::vector<Bone> bones;
  for (const Person& person : people)
    for (std::size_t j = person.count(); j-- > 0;) {  // ends first: where two bones meet a hand's shade wins
      const Joint& from = person.joints[j];
      if (from.state == JointState::kLost) continue;
      const JointDef& joint = person.skeleton->joints[j];
      const auto parent = static_cast<std::size_t>(std::max<int>(joint.parent, 0));
      const bool joined = joint.parent >= 0 && person.joints[parent].state != JointState::kLost;
      const Vec3 along_m = joined ? person.joints[parent].p_in_rig_m - from.p_in_rig_m : Vec3{};
      const double length2 = dot(along_m, along_m);
      constexpr double kWide = 1.4;  // of trunk, neck and head, whose skin is farther beside its bones than before them
      bones.push_back({&joint, joined ? &person.skeleton->joints[parent] : &joint, from.p_in_rig_m, along_m,
                       length2 > 0 ? 1 / length2 : 0, joint.side == Side::kMiddle ? kWide : 1});
    }
  return bones;
}

/// The joint whose part of a person holds the point; null = none.
const JointDef* part_at(Vec3 p_in_rig_m, const std::vector<Bone>& bones) {
  for (const Bone& bone : bones) {
    const Vec3 from_start = p_in_rig_m - bone.start_in_rig_m;
    const double t = std::clamp(dot(from_start, bone.along_m) * bone.inverse_length2, 0.0, 1.0);
    const Vec3 off = from_start - t * bone.along_m;
    const double radius_m = bone.wide * ((1 - t) * bone.from->radius_m + t * bone.to->radius_m);
    if (dot(off, off) < radius_m * radius_m) return t < 0.5 ? bone.from : bone.to;
  }
  return nullptr;
}

}  // namespace

Rgb8 shade_of(JointId joint) {
  constexpr std::array<Rgb8, 13> kShades = {{
      {120, 60, 130},   // pelvis
      {150, 80, 150},   // spine
      {180, 105, 165},  // chest
      {205, 140, 180},  // neck
      {235, 190, 210},  // head
      {24, 112, 62},    // shoulder
      {70, 190, 90},    // elbow
      {130, 222, 130},  // wrist
      {190, 255, 170},  // hand
      {30, 70, 140},    // hip
      {60, 120, 200},   // knee
      {110, 165, 230},  // ankle
      {170, 210, 255},  // foot
  }};
  constexpr auto kRightShoulder = static_cast<std::size_t>(JointId::kRightShoulder),
                 kLeftHip = static_cast<std::size_t>(JointId::kLeftHip),
                 kRightHip = static_cast<std::size_t>(JointId::kRightHip);
  constexpr std::size_t kSide = 4;  // joints of a limb
  const auto id = static_cast<std::size_t>(is_finger(joint) ? JointId::kLeftHand : joint);
  const std::size_t sides_before = (id >= kRightShoulder) + (id >= kRightHip);
  static_assert(kLeftHip == kRightShoulder + kSide && kRightHip == kLeftHip + kSide);
  return kShades[id - kSide * sides_before];
}

void draw_regions(const Frame& frame, const Rectified& rectified, std::span<const Person> people, View<Rgb8> dst) {
  DUO_CHECK(frame.color.size() == dst.size());
  const std::vector<Bone> bones = bones_of(people);
  for (int y = 0; y < dst.height(); ++y)
    for (int x = 0; x < dst.width(); ++x) {
      const Rgb8 c = frame.color.at(y, x);
      const int luma = (77 * c.r + 150 * c.g + 29 * c.b) >> 8;
      const auto p_in_rig_m = point_at(frame.disparity.d_q4, rectified, y, x);
      const JointDef* part = p_in_rig_m ? part_at(*p_in_rig_m, bones) : nullptr;
      if (part == nullptr) {
        const auto dark = static_cast<std::uint8_t>(luma / 4);
        dst.at(y, x) = {dark, dark, dark};
        continue;
      }
      // Some of the picture's own light keeps fingers and folds visible.
      const int light = 176 + luma * 80 / 255;
      const auto lit = [light](std::uint8_t channel) { return static_cast<std::uint8_t>(channel * light >> 8); };
      const Rgb8 shade = shade_of(part->id);
      dst.at(y, x) = {lit(shade.r), lit(shade.g), lit(shade.b)};
    }
}

}  // namespace duo
