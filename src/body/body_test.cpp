#include <gtest/gtest.h>

#include "duoptic/person.h"

namespace duo {
namespace {

TEST(Skeleton, FindsJointsAndSkeletonsByName) {
  for (const JointDef& joint : kBody.joints) {
    EXPECT_EQ(joint_named(joint.name), joint.id);
    EXPECT_EQ(name_of(joint.id), joint.name);
  }
  EXPECT_FALSE(joint_named("hand"));
  EXPECT_EQ(skeleton_named("left_arm"), &kLeftArm);
  EXPECT_EQ(skeleton_named("arm"), nullptr);
  EXPECT_EQ(kBody.joints.size(), kJointIds);
}

TEST(Skeleton, SidesAndParentsAgreeWithNames) {
  for (const Skeleton* skeleton : {&kBody, &kRightArm, &kLeftArm})
    for (std::size_t j = 0; j < skeleton->joints.size(); ++j) {
      const JointDef& joint = skeleton->joints[j];
      const Side side = joint.name.starts_with("left_")    ? Side::kLeft
                        : joint.name.starts_with("right_") ? Side::kRight
                                                           : Side::kMiddle;
      EXPECT_EQ(joint.side, side) << joint.name;
      EXPECT_LT(joint.parent, static_cast<int>(j)) << joint.name;
      EXPECT_EQ(skeleton->index_of(joint.id), j);
    }
  EXPECT_EQ(kBody.joints[static_cast<std::size_t>(kBody.joints[12].parent)].name, "right_wrist");
  EXPECT_EQ(kLeftArm.joints[static_cast<std::size_t>(kLeftArm.joints[2].parent)].name, "left_elbow");
  EXPECT_FALSE(kRightArm.index_of(JointId::kLeftHand));
}

TEST(Person, KeepsSigmaToTheLastBit) {
  for (double sigma_m = 1e-4; sigma_m < 10; sigma_m *= 1.0173) EXPECT_EQ(Covariance3::isotropic(sigma_m).sigma_m(), sigma_m);
  EXPECT_EQ(Covariance3::isotropic(0).sigma_m(), 0);
}

TEST(Person, SumsUpItsJoints) {
  Person person;
  person.skeleton = &kRightArm;
  person.joints[0] = {.state = JointState::kInferred, .confidence = 0.3, .u_px = 10, .v_px = 50};
  person.joints[1] = {.state = JointState::kSeen, .confidence = 0.9, .u_px = 30, .v_px = 20.4};
  person.joints[2] = {.state = JointState::kLost, .confidence = 0, .u_px = 500, .v_px = 500};
  person.sum_up();
  EXPECT_EQ(person.presence, Presence::kSeen);
  EXPECT_NEAR(person.confidence, 0.4, 1e-15);
  EXPECT_EQ(person.box_px, (Window{10, 20, 21, 31}));
  EXPECT_EQ(person.find(JointId::kRightElbow), &person.joints[1]);
  EXPECT_EQ(person.find(JointId::kLeftElbow), nullptr);
  person.joints[1].state = JointState::kInferred;
  person.sum_up();
  EXPECT_EQ(person.presence, Presence::kHidden);
  person.joints[0].state = person.joints[1].state = JointState::kLost;
  person.sum_up();
  EXPECT_EQ(person.presence, Presence::kLost);
  EXPECT_TRUE(person.box_px.empty());
}

}  // namespace
}  // namespace duo
