// Synthetic people who turn, walk, sit down and meet: they do what the script says, on their feet.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "duoptic/synthetic.h"
#include "sources/synthetic/script.h"

namespace duo {
namespace {

using namespace synthetic;

SyntheticClipFrame tiny_frame(const std::string& script, std::uint32_t seed, int index) {
  auto clip = SyntheticClip::open({.size = {64, 48}, .seed = seed, .script = script}, 2);
  EXPECT_TRUE(clip.has_value()) << clip.error().what;
  return clip->frame(index);
}

const SyntheticJoint& joint_of(const std::vector<SyntheticJoint>& joints, JointId id) {
  return *std::ranges::find(joints, id, &SyntheticJoint::id);
}

struct Standing {
  Vec3 left_shoulder, right_shoulder, pelvis;
  std::array<Vec3, 2> ankles, knees;
};
/// On the stage: x to the right of the picture, z away from the cameras.
Standing standing(const Script& script, double t_s) {
  const Script::Moment moment = script.at(t_s);
  const Bones bones = make_bones(moment.pose, 1);
  const auto at = [&](Vec3 p) { return moment.stage_from_person * p; };
  return {at(bones.arms[kLeftSide].root_m),
          at(bones.arms[kRightSide].root_m),
          at(bones.pelvis_m),
          {at(bones.legs[0].end_m), at(bones.legs[1].end_m)},
          {at(bones.legs[0].middle_m), at(bones.legs[1].middle_m)}};
}

TEST(SyntheticPerson, TurnsOnceAround) {
  const Script script(acts_of("turn"), kRightSide, 1);
  const auto across = [&](double t_s) { return standing(script, t_s).left_shoulder - standing(script, t_s).right_shoulder; };
  EXPECT_GT(across(0.2).x, 0.33);   // faces the cameras
  EXPECT_LT(across(1.7).x, -0.33);  // half way: its back
  EXPECT_LT(across(1.4).z * across(2.0).z, 0);
  EXPECT_GT(across(3.4).x, 0.33);
}

TEST(SyntheticPerson, WalksToAndFroOnItsFeet) {
  const Script script(acts_of("walk"), kLeftSide, 3);
  double most_apart_m = 0, low_x = 1, high_x = -1;
  int sign = 0, steps = 0;
  for (double t = 0; t < script.length_s(); t += 1.0 / 30) {
    const Standing now = standing(script, t);
    low_x = std::min(low_x, now.pelvis.x);
    high_x = std::max(high_x, now.pelvis.x);
    // One foot at least is near the floor, and none is below.
    EXPECT_LT(std::min(-now.ankles[0].y, -now.ankles[1].y), 0.125) << t;
    for (const Vec3& ankle : now.ankles) EXPECT_GT(-ankle.y, 0.09) << t;
    const double apart = now.ankles[0].x - now.ankles[1].x;
    most_apart_m = std::max(most_apart_m, std::abs(apart));
    if (std::abs(apart) < 0.25) continue;
    const int now_sign = apart > 0 ? 1 : -1;
    steps += now_sign != sign;
    sign = now_sign;
  }
  EXPECT_NEAR(high_x - low_x, 1.5, 0.05);
  EXPECT_GT(most_apart_m, 0.35);
  EXPECT_GE(steps, 3);
}

TEST(SyntheticPerson, SitsDownAndCrossesItsLegs) {
  for (const int arm : {kLeftSide, kRightSide}) {
    const Script script(acts_of("sit"), arm, 1);
    const Standing up = standing(script, 0.1), crossed = standing(script, 2.8);
    EXPECT_NEAR(crossed.pelvis.y - up.pelvis.y, 0.32, 0.03);
    EXPECT_GT(up.ankles[kLeftSide].x - up.ankles[kRightSide].x, 0.15);
    EXPECT_LT(crossed.ankles[kLeftSide].x - crossed.ankles[kRightSide].x, -0.02);
    EXPECT_LT(crossed.knees[arm].y, crossed.knees[1 - arm].y - 0.05);  // over the other
    EXPECT_NEAR(standing(script, script.length_s() - 0.05).pelvis.y, up.pelvis.y, 0.02);
  }
}

TEST(SyntheticPerson, TwoMeetAndOneHidesTheOther) {
  auto clip = SyntheticClip::open({.size = {64, 48}, .seed = 1, .script = "cross"}, 2);
  ASSERT_TRUE(clip.has_value());
  int hidden = 0;
  double before = 0;
  for (const int index : {0, 36, 44, 48, 52, 60, 90}) {
    const SyntheticClipFrame frame = clip->frame(index);
    ASSERT_EQ(frame.others.size(), 1U);
    const SyntheticJoint &far = joint_of(frame.joints, JointId::kPelvis), &near = joint_of(frame.others[0], JointId::kPelvis);
    EXPECT_LT(near.p_in_left_m.z, far.p_in_left_m.z - 0.3);
    hidden += far.in_left && !far.visible_left;
    const double apart = near.p_in_left_m.x - far.p_in_left_m.x;
    if (index == 0) before = apart;
    if (index == 90) {
      EXPECT_LT(apart * before, 0);
    }
  }
  EXPECT_GE(hidden, 1);
  EXPECT_LE(hidden, 5);
  EXPECT_TRUE(tiny_frame("walk", 1, 0).others.empty());
}

TEST(SyntheticPerson, WholeBodiesAreInThePicture) {
  for (const std::uint32_t seed : {1U, 2U, 3U}) {
    const SyntheticClipFrame frame = tiny_frame("turn", seed, 0);
    for (const JointId id : {JointId::kHead, JointId::kLeftAnkle, JointId::kRightFoot, JointId::kLeftHand})
      EXPECT_TRUE(joint_of(frame.joints, id).in_left) << name_of(id);
  }
}

}  // namespace
}  // namespace duo
