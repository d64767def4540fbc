#include "trackers/body/body.h"

namespace duo::body {

void Body::learn_pace(double ticks) {
  using enum JointId;
  constexpr double kGain = 0.2;  // per tick
  Vec3 sum;
  int count = 0;
  for (const JointId id : {kLeftShoulder, kRightShoulder, kLeftHip, kRightHip})
    if (states_[id].seen) {
      sum = sum + states_[id].step;
      ++count;
    }
  const double gain = gain_over(ticks, kGain);
  if (count > 1) pace_ = (1 - gain) * pace_ + (gain / count) * sum;
}

void Body::learn(const FrameView& frame, const Scene& scene) {
  using enum JointId;
  constexpr double kFacing = 0.7;  // of the width: turned by less than 45 degrees
  constexpr double kInLine = 0.9;  // within 25 degrees
  constexpr double kSureKnee = 0.85, kBelow_m = 0.02;
  // What is seen of a hip behind its thigh is the thigh.
  const auto seen = [&](JointId id) { return states_[id].seen && !(is_hip(id) && states_[id].hidden_by_limb); };
  const auto measured = [&](JointId id) {
    return scene.depth.geometry->unproject(scene.points[id].at_px, fitted_.places[id].z);
  };
  const auto take = [&](JointId a, JointId b, Bone bone) {
    if (!seen(a) || !seen(b)) return;
    const Vec3 way = measured(b) - measured(a);
    const double measured_m = std::max(norm(way), 1e-6), across = std::sqrt(square(way.x) + square(way.y)) / measured_m;
    const double weight = square(across) * std::min(scene.points[a].visibility, scene.points[b].visibility);
    if (across > 0.5) lengths_.learn(bone, measured_m, weight);
  };
  for (const Limb& arm : kArmChains) {
    take(arm[0], arm[1], Bone::kUpperArm);
    take(arm[1], arm[2], Bone::kForearm);
    take(arm[2], arm[3], Bone::kPalm);
  }
  for (const Limb& leg : kLegChains) {
    take(leg[0], leg[1], Bone::kThigh);
    take(leg[1], leg[2], Bone::kShin);
    take(leg[2], leg[3], Bone::kFoot);
  }
  if (std::abs(scene.across.shoulders.z) < kFacing) take(kLeftShoulder, kRightShoulder, Bone::kShoulders);
  if (std::abs(scene.across.hips.z) < kFacing) take(kLeftHip, kRightHip, Bone::kHips);
  if (seen(kLeftShoulder) && seen(kRightShoulder) && seen(kLeftHip) && seen(kRightHip)) {
    const Vec3 shoulders = middle(measured(kLeftShoulder), measured(kRightShoulder)) + scene.lift_m(),
               hips = middle(measured(kLeftHip), measured(kRightHip));
    lengths_.learn(Bone::kTrunk, distance(shoulders, hips), 1);
    if (seen(kHead)) {
      lengths_.learn(Bone::kNeckHead, distance(shoulders, measured(kHead)), 1);
      lengths_.learn(Bone::kHead, distance(fitted_.places[kNeck], fitted_.places[kHead]), 1);
    }
    const double low_m = hip_mark_.low_m();  // by which the marks of this frame were moved up
    for (const Limb& leg : kLegChains) {
      const Vec3 trunk = hips - shoulders, thigh = measured(leg[1]) - measured(leg[0]);
      const double in_line = dot(trunk, thigh) / std::max(norm(trunk) * norm(thigh), 1e-6);
      // A knee below the picture is marked at its border.
      Vec2 below = scene.points[leg[1]].at_px;
      below.y += kBelow_m * frame.depth.px_per_m(fitted_.places[leg[1]].z);
      const bool sure = seen(leg[1]) && scene.points[leg[1]].visibility > kSureKnee && frame.shows(below);
      if (sure && in_line > kInLine) hip_mark_.learn(norm(trunk), norm(thigh), low_m);
    }
    lengths_.lengthen(Bone::kTrunk, low_m - hip_mark_.low_m());
    lengths_.lengthen(Bone::kThigh, hip_mark_.low_m() - low_m);
    lengths_.lengthen(Bone::kHead, kNeckAbove * (hip_mark_.low_m() - low_m));
    if (std::abs(scene.across.shoulders.z) < kFacing)
      map_.learn(scene.depth, trunk_axes(fitted_.places), fitted_.places, frame.ticks());
  }
}

}  // namespace duo::body
