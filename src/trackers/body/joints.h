// The joints of a body and what is known of every adult: sizes as shares, how fast joints move. Constants of a single step
// stand beside it.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "duoptic/geometry.h"
#include "duoptic/skeleton.h"
#include "trackers/body/over_time.h"

namespace duo::body {

inline constexpr std::size_t kJoints = kBodyJointIds;
inline constexpr std::size_t index_of(JointId id) { return static_cast<std::size_t>(id); }

/// A value per joint, by JointId.
template <class T>
struct PerJoint {
  std::array<T, kJoints> all = {};
  T& operator[](JointId id) { return all[index_of(id)]; }
  const T& operator[](JointId id) const { return all[index_of(id)]; }
};

using Places = PerJoint<Vec3>;  // metres, rig frame

/// The joints that are found; pelvis, spine, chest and neck follow from shoulders and hips.
inline constexpr std::array kFreeJoints = {
    JointId::kHead,          JointId::kLeftShoulder, JointId::kLeftElbow,  JointId::kLeftWrist, JointId::kLeftHand,
    JointId::kRightShoulder, JointId::kRightElbow,   JointId::kRightWrist, JointId::kRightHand, JointId::kLeftHip,
    JointId::kLeftKnee,      JointId::kLeftAnkle,    JointId::kLeftFoot,   JointId::kRightHip,  JointId::kRightKnee,
    JointId::kRightAnkle,    JointId::kRightFoot};

/// A limb from its root to its end. Left before right.
using Limb = std::array<JointId, 4>;
inline constexpr std::array<Limb, 2> kArmChains = {{
    {JointId::kLeftShoulder, JointId::kLeftElbow, JointId::kLeftWrist, JointId::kLeftHand},
    {JointId::kRightShoulder, JointId::kRightElbow, JointId::kRightWrist, JointId::kRightHand},
}};
inline constexpr std::array<Limb, 2> kLegChains = {{
    {JointId::kLeftHip, JointId::kLeftKnee, JointId::kLeftAnkle, JointId::kLeftFoot},
    {JointId::kRightHip, JointId::kRightKnee, JointId::kRightAnkle, JointId::kRightFoot},
}};

constexpr bool is_left(JointId id) {
  return (id >= JointId::kLeftShoulder && id <= JointId::kLeftHand) || (id >= JointId::kLeftHip && id <= JointId::kLeftFoot);
}
constexpr bool is_shoulder(JointId id) { return id == JointId::kLeftShoulder || id == JointId::kRightShoulder; }
/// Elbow, wrist or hand.
constexpr bool is_arm(JointId id) {
  return (id >= JointId::kLeftElbow && id <= JointId::kLeftHand) || (id >= JointId::kRightElbow && id <= JointId::kRightHand);
}
constexpr bool is_hand_or_wrist(JointId id) {
  return id == JointId::kLeftWrist || id == JointId::kLeftHand || id == JointId::kRightWrist || id == JointId::kRightHand;
}
/// Of the trunk or the head: no limb carries it.
constexpr bool is_root(JointId id) {
  return is_shoulder(id) || id == JointId::kLeftHip || id == JointId::kRightHip || id == JointId::kHead;
}
constexpr bool is_hip(JointId id) { return id == JointId::kLeftHip || id == JointId::kRightHip; }

inline Vec2 mean(Vec2 a, Vec2 b) { return {(a.x + b.x) / 2, (a.y + b.y) / 2}; }
inline Vec3 middle(Vec3 a, Vec3 b) { return 0.5 * (a + b); }
constexpr double square(double x) { return x * x; }
inline double distance(Vec3 a, Vec3 b) { return norm(a - b); }
inline double distance(Vec2 a, Vec2 b) { return std::sqrt(square(a.x - b.x) + square(a.y - b.y)); }
/// From a point to the nearest one between a and b.
inline double to_segment(Vec2 p, Vec2 a, Vec2 b) {
  const Vec2 way = {b.x - a.x, b.y - a.y};
  const double along = (p.x - a.x) * way.x + (p.y - a.y) * way.y;
  const double t = std::clamp(along / std::max(square(way.x) + square(way.y), 1e-9), 0.0, 1.0);
  return distance(p, {a.x + t * way.x, a.y + t * way.y});
}
inline double to_segment(Vec3 p, Vec3 a, Vec3 b) {
  const Vec3 way = b - a;
  const double t = std::clamp(dot(p - a, way) / std::max(dot(way, way), 1e-9), 0.0, 1.0);
  return distance(p, a + t * way);
}

/// How far a joint may move from where it was expected: one standard deviation.
///
/// Units  metres per tick
constexpr double unrest_m(JointId id) {
  using enum JointId;
  switch (id) {
    case kHead:
      return 0.035;
    case kLeftShoulder:
    case kRightShoulder:
    case kLeftElbow:
    case kRightElbow:
      return 0.026;
    case kLeftWrist:
    case kRightWrist:
      return 0.035;
    case kLeftHand:
    case kRightHand:
      return 0.040;
    case kLeftKnee:
    case kRightKnee:
      return 0.026;
    case kLeftAnkle:
    case kRightAnkle:
    case kLeftFoot:
    case kRightFoot:
      return 0.035;
    default:
      return 0.020;
  }
}

}  // namespace duo::body
