// Persons for the tests of sinks.
#pragma once

#include <random>
#include <vector>

#include "duoptic/sink.h"

namespace duo::test {

inline constexpr double kUpper_m = 0.31, kLower_m = 0.27;

inline Joint joint(Vec3 p_m, JointState state = JointState::kSeen) {
  return {
      .p_in_rig_m = p_m, .cov_m2 = Covariance3::isotropic(0.0125), .state = state, .confidence = 0.9, .u_px = 30, .v_px = 20};
}

/// Every joint lost.
inline Person person_with(const Skeleton& skeleton, std::uint32_t id = 1) {
  Person person;
  person.id = id;
  person.skeleton = &skeleton;
  return person;
}

inline Joint& joint_of(Person& person, JointId id) { return person.joints[*person.skeleton->index_of(id)]; }
inline const Joint& joint_of(const Person& person, JointId id) { return person.joints[*person.skeleton->index_of(id)]; }

// The joints of an arm in the order of its skeleton.
inline constexpr std::size_t kShoulder = 0, kElbow = 1, kHand = 2;

inline Person arm_of(Vec3 shoulder, Vec3 elbow, Vec3 hand, const Skeleton& skeleton = kRightArm, std::uint32_t id = 1) {
  Person arm = person_with(skeleton, id);
  arm.joints[kShoulder] = joint(shoulder);
  arm.joints[kElbow] = joint(elbow);
  arm.joints[kHand] = joint(hand);
  return arm;
}

/// An arm with fixed bones that wanders through every pose: bent, straight, up, down and sideways.
inline std::vector<Person> wandering_arm(int frames, unsigned seed, const Skeleton& skeleton = kRightArm,
                                         std::uint32_t id = 1) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  const auto direction = [&] { return normalized(Vec3{normal(random), normal(random), normal(random)}); };
  std::vector<Person> out;
  for (int i = 0; i < frames; ++i) {
    const Vec3 shoulder = Vec3{0.1, -0.2, 1.6} + 0.1 * direction();
    Vec3 upper = direction(), lower = direction();
    if (i % 7 == 1) upper = {0, i % 2 == 0 ? 1.0 : -1.0, 0};
    if (i % 7 == 2) upper = {i % 2 == 0 ? 1.0 : -1.0, 0, 0};
    if (i % 5 == 3) lower = normalized(upper + 0.01 * lower);
    if (i % 11 == 4) lower = upper;
    const Vec3 elbow = shoulder + kUpper_m * upper;
    out.push_back(arm_of(shoulder, elbow, elbow + kLower_m * lower, skeleton, id));
  }
  return out;
}

struct Instant {
  std::shared_ptr<Picture> shared_left = std::make_shared<Picture>();
  std::shared_ptr<Frame> shared_frame = std::make_shared<Frame>();
  Picture& left = *shared_left;
  Frame& frame = *shared_frame;
  std::vector<Person> people;
  TrackedFrame tracked(std::int64_t number) const {
    return {number, static_cast<double>(number) / 30, shared_left, shared_frame, people, {}};
  }
};

}  // namespace duo::test
