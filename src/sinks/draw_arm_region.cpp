#include <algorithm>
#include <cmath>
#include <vector>

#include "core/check.h"
#include "sinks/panels.h"
#include "sinks/point.h"

namespace duo {
namespace {

// From the bone to the skin and a little more; the hand is a palm's centre with fingers around it.
constexpr std::array<double, kArmJoints> kRadius_m = {0.11, 0.075, 0.11};

/// A piece of the arm between two joints, or around one when both are the same.
struct Bone {
  std::size_t from, to;
  Vec3 start_in_rig_m, along_m;
  double inverse_length2;  // 1/m², 0 for a single joint
};

std::vector<Bone> bones_of(const std::vector<ArmPose>& arms) {
  std::vector<Bone> bones;
  for (const ArmPose& arm : arms)
    for (std::size_t j = 0; j < kArmJoints; ++j) {
      const Keypoint& from = arm.joints[j];
      if (from.state == JointState::kLost) continue;
      const std::size_t next = j + 1;
      const bool joined = next < kArmJoints && arm.joints[next].state != JointState::kLost;
      const Vec3 along_m = joined ? arm.joints[next].p_in_rig_m - from.p_in_rig_m : Vec3{};
      const double length2 = dot(along_m, along_m);
      bones.push_back({j, joined ? next : j, from.p_in_rig_m, along_m, length2 > 0 ? 1 / length2 : 0});
    }
  return bones;
}

/// The joint whose part of the arm holds the point; kArmJoints = none.
std::size_t part_of(Vec3 p_in_rig_m, const std::vector<Bone>& bones) {
  for (const Bone& bone : bones) {
    const Vec3 from_start = p_in_rig_m - bone.start_in_rig_m;
    const double t = std::clamp(dot(from_start, bone.along_m) * bone.inverse_length2, 0.0, 1.0);
    const Vec3 off = from_start - t * bone.along_m;
    const double radius_m = (1 - t) * kRadius_m[bone.from] + t * kRadius_m[bone.to];
    if (dot(off, off) < radius_m * radius_m) return t < 0.5 ? bone.from : bone.to;
  }
  return kArmJoints;
}

}  // namespace

void draw_arm_region(const Frame& frame, const Rectified& rectified, const std::vector<ArmPose>& arms, View<Rgb8> dst) {
  DUO_CHECK(frame.color.size() == dst.size());
  const std::vector<Bone> bones = bones_of(arms);
  for (int y = 0; y < dst.height(); ++y)
    for (int x = 0; x < dst.width(); ++x) {
      const Rgb8 c = frame.color.at(y, x);
      const int luma = (77 * c.r + 150 * c.g + 29 * c.b) >> 8;
      const auto p_in_rig_m = point_at(frame.disparity.d_q4, rectified, y, x);
      const std::size_t part = p_in_rig_m ? part_of(*p_in_rig_m, bones) : kArmJoints;
      if (part == kArmJoints) {
        const auto dark = static_cast<std::uint8_t>(luma / 4);
        dst.at(y, x) = {dark, dark, dark};
        continue;
      }
      // Some of the picture's own light keeps fingers and folds visible.
      const int light = 176 + luma * 80 / 255;
      const auto lit = [light](std::uint8_t channel) { return static_cast<std::uint8_t>(channel * light >> 8); };
      dst.at(y, x) = {lit(kJointShades[part].r), lit(kJointShades[part].g), lit(kJointShades[part].b)};
    }
}

}  // namespace duo
