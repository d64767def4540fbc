// Arms for the tests of sinks.
#pragma once

#include <random>
#include <vector>

#include "duoptic/sink.h"

namespace duo::test {

inline constexpr double kUpper_m = 0.31, kLower_m = 0.27;

inline Keypoint joint(Vec3 p_m, JointState state = JointState::kSeen) { return {p_m, 0.0125, 0.9, 30, 20, state}; }

inline ArmPose arm_of(Vec3 shoulder, Vec3 elbow, Vec3 hand) {
  ArmPose arm;
  arm[Joint::kShoulder] = joint(shoulder);
  arm[Joint::kElbow] = joint(elbow);
  arm[Joint::kHand] = joint(hand);
  return arm;
}

/// An arm with fixed bones that wanders through every pose: bent, straight, up, down and sideways.
inline std::vector<ArmPose> wandering_arm(int frames, unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  const auto direction = [&] { return normalized(Vec3{normal(random), normal(random), normal(random)}); };
  std::vector<ArmPose> out;
  for (int i = 0; i < frames; ++i) {
    const Vec3 shoulder = Vec3{0.1, -0.2, 1.6} + 0.1 * direction();
    Vec3 upper = direction(), lower = direction();
    if (i % 7 == 1) upper = {0, i % 2 == 0 ? 1.0 : -1.0, 0};
    if (i % 7 == 2) upper = {i % 2 == 0 ? 1.0 : -1.0, 0, 0};
    if (i % 5 == 3) lower = normalized(upper + 0.01 * lower);
    if (i % 11 == 4) lower = upper;
    const Vec3 elbow = shoulder + kUpper_m * upper;
    out.push_back(arm_of(shoulder, elbow, elbow + kLower_m * lower));
  }
  return out;
}

struct Instant {
  Picture left;
  Frame frame;
  std::vector<ArmPose> arms;
  TrackedFrame tracked(std::int64_t number) const { return {number, static_cast<double>(number) / 30, left, frame, arms, {}}; }
};

inline TrackHeader header_of(ArmSide first_arm) {
  TrackHeader header;
  header.first_arm = first_arm;
  return header;
}

}  // namespace duo::test
