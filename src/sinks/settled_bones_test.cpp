// Frames that wait until the lengths of bones are known: lengths by hand.
#include "sinks/settled_bones.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "body/bone_turns.h"
#include "tests/arm_poses.h"

namespace duo {
namespace {

using namespace test;  // NOLINT: the persons

struct Arrived {
  std::vector<std::int64_t> numbers;
  std::vector<std::vector<Person>> people;
  bool finished = false;
};

struct KeepsArrived final : Sink {
  explicit KeepsArrived(Arrived& to) : to_(to) {}
  Result<void> write(const TrackedFrame& frame) override {
    to_.numbers.push_back(frame.number);
    to_.people.emplace_back(frame.people.begin(), frame.people.end());
    return {};
  }
  Result<void> finish() override {
    to_.finished = true;
    return {};
  }
  Arrived& to_;
};

std::unique_ptr<Sink> settled(Arrived& to) {
  Rig rig;
  rig.left.size = {640, 480};
  rig.left.fx_px = rig.left.fy_px = 500;
  rig.left.cx_px = 320;
  rig.left.cy_px = 240;
  return with_settled_bones(std::make_unique<KeepsArrived>(to), rig, {});
}

/// In the T-pose at 2 m, all bones of that length.
Person body_of(double bone_m, std::uint32_t id = 1) {
  Person out = person_with(kBody);
  out.id = id;
  for (std::size_t j = 0; j < kBody.joints.size(); ++j) {
    const int parent = kBody.joints[j].parent;
    const Vec3 from = parent < 0 ? Vec3{0, 0, 2} : out.joints[static_cast<std::size_t>(parent)].p_in_rig_m;
    const Vec3 rest = parent < 0 ? Vec3{} : rest_direction(kBody.joints[j].id, BodyAxes::kRightHanded);
    out.joints[j] = joint(from + bone_m * (axes_from_rig(Axes::kOpengl) * rest));
  }
  return out;
}

double bone_m(const Person& person, JointId end) {
  const std::size_t j = static_cast<std::size_t>(end);
  return norm(person.joints[j].p_in_rig_m - person.joints[static_cast<std::size_t>(kBody.joints[j].parent)].p_in_rig_m);
}

TEST(SettledBones, TheFirstFramesHaveTheLengthsThatTheLaterOnesSettleAt) {
  Arrived arrived;
  const auto sink = settled(arrived);
  Instant instant;
  for (int i = 0; i < 40; ++i) {
    instant.people = {body_of(0.2 + 0.001 * std::min(i, 20))};
    ASSERT_TRUE(sink->write(instant.tracked(i)));
    EXPECT_EQ(arrived.numbers.size(), i < 30 ? 0u : static_cast<std::size_t>(i) + 1) << i;  // ten frames alike
  }
  ASSERT_TRUE(sink->finish());
  EXPECT_TRUE(arrived.finished);
  ASSERT_EQ(arrived.numbers.size(), 40u);
  for (std::size_t i = 0; i < 40; ++i) {
    EXPECT_EQ(arrived.numbers[i], static_cast<std::int64_t>(i));
    const Person &before = body_of(0.2 + 0.001 * std::min<double>(static_cast<double>(i), 20)), &after = arrived.people[i][0];
    Vec3 moved;
    for (std::size_t j = 0; j < kBody.joints.size(); ++j)
      moved = moved + (after.joints[j].p_in_rig_m - before.joints[j].p_in_rig_m);
    for (std::size_t j = 1; j < kBody.joints.size(); ++j) EXPECT_NEAR(bone_m(after, static_cast<JointId>(j)), 0.22, 1e-9) << i;
    EXPECT_LT(norm(moved), 1e-9) << "on the mean joints stay where they were";
    const Joint& hand = *after.find(JointId::kLeftHand);
    if (i >= 20) continue;
    EXPECT_NEAR(hand.u_px, 320 + 500 * hand.p_in_rig_m.x / hand.p_in_rig_m.z, 1e-9);
  }
}

/// The first person waits for the second one no longer than for itself, and a lost joint has no length.
TEST(SettledBones, WhoChangesOnHasTheLengthsOfTheLastFrameThatCanWait) {
  Arrived arrived;
  const auto sink = settled(arrived);
  Instant instant;
  for (int i = 0; i < 100; ++i) {
    instant.people = {body_of(0.3), body_of(0.2 + 0.001 * i, 2)};
    instant.people[1].joints[static_cast<std::size_t>(JointId::kLeftFoot)].state = JointState::kLost;
    ASSERT_TRUE(sink->write(instant.tracked(i)));
  }
  EXPECT_EQ(arrived.numbers.size(), 100u);
  ASSERT_TRUE(sink->finish());
  EXPECT_NEAR(bone_m(arrived.people[0][0], JointId::kLeftElbow), 0.3, 1e-9);
  EXPECT_NEAR(bone_m(arrived.people[0][1], JointId::kLeftElbow), 0.275, 1e-9);
  EXPECT_NEAR(bone_m(arrived.people[0][1], JointId::kLeftFoot), 0.2, 1e-9);
  EXPECT_NEAR(bone_m(arrived.people[94][1], JointId::kLeftElbow), 0.275, 1e-9);
  EXPECT_NEAR(bone_m(arrived.people[96][1], JointId::kLeftElbow), 0.2955, 6e-4) << "more than 2 cm off";
}

TEST(SettledBones, ArmsAndNobodyWaitForNothingAndTheEndWritesAll) {
  Arrived arrived;
  const auto sink = settled(arrived);
  Instant instant;
  ASSERT_TRUE(sink->write(instant.tracked(0)));
  instant.people = {arm_of({0.1, -0.25, 1.5}, {0, 0, 2}, {1, 2, 3})};
  ASSERT_TRUE(sink->write(instant.tracked(1)));
  EXPECT_EQ(arrived.numbers.size(), 2u);
  instant.people = {body_of(0.2)};
  ASSERT_TRUE(sink->write(instant.tracked(2)));
  instant.people = {body_of(0.25)};
  ASSERT_TRUE(sink->write(instant.tracked(3)));
  EXPECT_EQ(arrived.numbers.size(), 2u);
  ASSERT_TRUE(sink->flush());
  EXPECT_FALSE(arrived.finished);
  ASSERT_EQ(arrived.numbers.size(), 4u);
  instant.people = {body_of(0.3, 2)};
  ASSERT_TRUE(sink->write(instant.tracked(4)));
  ASSERT_TRUE(sink->finish());
  ASSERT_EQ(arrived.numbers.size(), 5u);
  EXPECT_NEAR(bone_m(arrived.people[2][0], JointId::kLeftElbow), 0.25, 1e-9);
}

}  // namespace
}  // namespace duo
