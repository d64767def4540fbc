#include "sources/synthetic/bones.h"

#include <algorithm>
#include <cmath>

#include "sources/synthetic/noise.h"

namespace duo::synthetic {
namespace {

// y along the bone, x across as near to `hinge` as can be.
Rigid3 along(Vec3 from_m, Vec3 to_m, Vec3 hinge) {
  const Vec3 y = normalized(to_m - from_m), z = normalized(cross(hinge, y)), x = cross(y, z);
  return {transposed(Mat3::from_rows(x, y, z)), from_m};
}

// Two bones from `root` to `end`, bent towards `bend`.
Limb reach(Vec3 root_m, Vec3 end_m, Vec3 bend, double upper_m, double lower_m) {
  const Vec3 way = end_m - root_m;
  const double distance = std::clamp(norm(way), 0.3 * (upper_m + lower_m), 0.998 * (upper_m + lower_m));
  const Vec3 direction = normalized(way), side = normalized(bend - dot(bend, direction) * direction);
  const double foot = (upper_m * upper_m - lower_m * lower_m + distance * distance) / (2 * distance);
  const double height = std::sqrt(std::max(upper_m * upper_m - foot * foot, 0.0));
  Limb limb;
  limb.root_m = root_m;
  limb.middle_m = root_m + foot * direction + height * side;
  limb.end_m = root_m + distance * direction;
  const Vec3 hinge = cross(side, direction);
  limb.person_from_upper = along(root_m, limb.middle_m, hinge);
  limb.person_from_lower = along(limb.middle_m, limb.end_m, hinge);
  return limb;
}

}  // namespace

Fingers make_fingers(const ArmPose& pose, int side) {
  struct Shape {
    double x, y, first, second;
  };
  constexpr std::array<Shape, 4> kShapes = {{{0.029, 0.086, 0.041, 0.036},
                                             {0.0098, 0.09, 0.046, 0.041},
                                             {-0.0098, 0.088, 0.042, 0.037},
                                             {-0.028, 0.08, 0.033, 0.028}}};
  constexpr double kInPalm_m = 0.012, kPinched_degrees = 38;
  const double thumb = -outwards(side);
  Fingers out;
  for (std::size_t i = 0; i < kShapes.size(); ++i) {
    const Shape& shape = kShapes[i];
    const double spread = 0.12 * shape.x / 0.029;
    const double curl = i == 0 ? pose.curl_degrees + pose.pinch * (kPinched_degrees - pose.curl_degrees) : pose.curl_degrees;
    const auto towards = [&](double degrees) { return about_x(degrees) * normalized(Vec3{thumb * spread, 1, 0}); };
    Finger& finger = out[1 + i];
    finger.root_m = {thumb * shape.x, shape.y - kInPalm_m, 0};
    finger.bend_m = finger.root_m + (shape.first + kInPalm_m) * towards(curl);
    finger.tip_m = finger.bend_m + shape.second * towards(2.2 * curl);
  }
  // The thumb goes to the finger, whose skin is as thick as its own.
  const Vec3 touch = out[1].tip_m + Vec3{thumb * 0.004, -0.012, 0.008};
  out[0] = {{thumb * 0.02, 0.02, 0.008}, {thumb * 0.046, 0.053, 0.014}, {thumb * 0.06, 0.098, 0.018}};
  out[0].bend_m = out[0].bend_m + pose.pinch * Vec3{0, 0.004, 0.022};
  out[0].tip_m = out[0].tip_m + pose.pinch * (touch - out[0].tip_m);
  return out;
}

Bones make_bones(const Pose& pose, double scale) {
  Bones out;
  out.scale = scale;
  const Vec3 hips{0, -0.93 * scale, 0};
  Mat3 turn = about_z(pose.lean_degrees) * about_y(pose.twist_degrees);
  if (pose.bow_degrees != 0) turn = turn * about_x(pose.bow_degrees);
  out.person_from_torso = Rigid3{{}, hips + pose.hips_m} * Rigid3{turn, {}} * Rigid3{{}, -1.0 * hips};
  const auto torso = [&](double x, double y, double z) { return out.person_from_torso * (scale * Vec3{x, y, z}); };
  out.pelvis_m = torso(0, -0.926, 0.002);
  out.neck_m = torso(0, -1.525, 0.04);
  out.person_from_head = {out.person_from_torso.rotation * about_y(pose.look_degrees) * about_x(pose.nod_degrees),
                          torso(0, -kHeadHeight_m, -0.01)};
  out.head_m = out.person_from_head * (scale * Vec3{0, -0.075, 0.04});
  for (int side = 0; side < 2; ++side) {
    const double s = outwards(side);
    const ArmPose& arm = pose.arms[side];
    const auto turned = [&](Vec3 v) { return out.person_from_torso.rotation * Vec3{s * v.x, v.y, v.z}; };
    const Vec3 shoulder = torso(s * 0.178, -kShoulderHeight_m, 0.01);
    Limb& limb = out.arms[side];
    limb = reach(shoulder, shoulder + scale * turned(arm.wrist_m), turned(arm.elbow), scale * kUpperArm_m, scale * kForearm_m);
    const Vec3 forearm = normalized(limb.end_m - limb.middle_m), hand = normalized(forearm + turned(arm.fingers));
    const Vec3 palm = turned(arm.palm);
    limb.person_from_end = along(limb.end_m, limb.end_m + hand, cross(hand, palm));
    out.fingers[side] = make_fingers(arm, side);
    out.hands_m[side] = limb.end_m + scale * kPalm_m * hand;

    const LegPose& leg = pose.legs[side];
    const auto mirrored = [s](Vec3 v) { return Vec3{s * v.x, v.y, v.z}; };
    const Vec3 hip = torso(s * 0.092, -0.915, 0.01);
    out.legs[side] = reach(hip, scale * mirrored(leg.ankle_m), mirrored(leg.knee), scale * kThigh_m, scale * kShin_m);
    Rigid3& foot = out.legs[side].person_from_end;
    foot = {{}, out.legs[side].end_m};
    if (leg.toes_degrees != 0) foot.rotation = about_x(leg.toes_degrees);
    out.feet_m[side] = foot * (scale * Vec3{s * 0.03, 0.06, -0.13});
  }
  return out;
}

}  // namespace duo::synthetic
