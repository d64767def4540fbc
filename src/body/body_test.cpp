#include <gtest/gtest.h>

#include "body/bone_turns.h"
#include "duoptic/person.h"

namespace duo {
namespace {

TEST(Skeleton, FindsJointsAndSkeletonsByName) {
  for (const JointDef& joint : kBodyHands.joints) {
    EXPECT_EQ(joint_named(joint.name), joint.id);
    EXPECT_EQ(name_of(joint.id), joint.name);
  }
  EXPECT_FALSE(joint_named("hand"));
  EXPECT_EQ(skeleton_named("left_arm"), &kLeftArm);
  EXPECT_EQ(skeleton_named("arm"), nullptr);
  EXPECT_EQ(kBody.joints.size(), kBodyJointIds);
  EXPECT_EQ(kBodyHands.joints.size(), kJointIds);
  EXPECT_EQ(finger_joint(Side::kRight, {1, 3}), JointId::kRightIndexTip);
  EXPECT_EQ(finger_joint(Side::kLeft, {4, 3}), JointId::kLeftPinkyTip);
  const FingerJoint ring_middle = finger_of(JointId::kRightRingPip);
  EXPECT_EQ(ring_middle.finger, 3u);
  EXPECT_EQ(ring_middle.joint, 1u);
}

TEST(Skeleton, SidesAndParentsAgreeWithNames) {
  for (const Skeleton* skeleton : {&kBody, &kBodyHands, &kRightArm, &kLeftArm})
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

/// By hand: tips 3 cm apart along x and 4 cm along z, with 2 and 1 mm of doubt along x, 0 and 5 mm along z: along the line
/// between them sqrt(0.6^2 (4 + 1) + 0.8^2 25) = sqrt(17.8) mm.
TEST(Person, PinchByHand) {
  Person person;
  person.skeleton = &kBodyHands;
  const auto at = [&](JointId id) -> Joint& { return person.joints[static_cast<std::size_t>(id)]; };
  EXPECT_FALSE(pinch_of(person, Side::kRight)) << "both are lost";
  at(JointId::kRightThumbTip) = {.p_in_rig_m = {0.1, 0, 1}, .cov_m2 = {.xx = 4e-6}, .state = JointState::kSeen};
  EXPECT_FALSE(pinch_of(person, Side::kRight));
  at(JointId::kRightIndexTip) = {
      .p_in_rig_m = {0.13, 0, 1.04}, .cov_m2 = {.xx = 1e-6, .zz = 25e-6}, .state = JointState::kInferred};
  const auto pinch = pinch_of(person, Side::kRight);
  ASSERT_TRUE(pinch);
  EXPECT_NEAR(pinch->distance_m, 0.05, 1e-12);
  EXPECT_NEAR(pinch->sigma_m, std::sqrt(17.8e-6), 1e-12);
  EXPECT_FALSE(pinch_of(person, Side::kLeft));
  at(JointId::kRightThumbTip).state = JointState::kInferred;
  EXPECT_FALSE(pinch_of(person, Side::kRight)) << "neither is seen";
  person.skeleton = &kBody;
  EXPECT_FALSE(pinch_of(person, Side::kRight));
}

/// Places of a body in its T-pose, each bone 0.2 long.
std::vector<Vec3> t_pose(const Skeleton& skeleton = kBody) {
  std::vector<Vec3> out(skeleton.joints.size());
  for (std::size_t j = 1; j < out.size(); ++j)
    out[j] = out[static_cast<std::size_t>(skeleton.joints[j].parent)] +
             0.2 * rest_direction(skeleton.joints[j].id, BodyAxes::kRightHanded);
  return out;
}

void expect_turn(const Mat3& got, const Mat3& want, const std::string& what) {
  for (std::size_t i = 0; i < 9; ++i) EXPECT_NEAR(got.m[i], want.m[i], 1e-9) << what << " " << i;
}

TEST(KnownPlaces, LostLimbsHangFromTheTrunk) {
  Person person;
  person.skeleton = &kBody;
  for (std::size_t j = 0; j < person.count(); ++j) {
    person.joints[j].state = JointState::kSeen;
    person.joints[j].p_in_rig_m = {0, -0.1 * static_cast<double>(j), 2};
  }
  const auto at = [&](JointId id) -> Joint& { return person.joints[static_cast<std::size_t>(id)]; };
  at(JointId::kPelvis).p_in_rig_m = {0, 0, 2};
  at(JointId::kChest).p_in_rig_m = {0, -0.3, 2};
  at(JointId::kLeftShoulder).p_in_rig_m = {0.2, -0.4, 2};
  at(JointId::kRightShoulder).p_in_rig_m = {-0.2, -0.4, 2};
  at(JointId::kLeftKnee).p_in_rig_m = {0.1, 0.4, 2};
  at(JointId::kLeftAnkle).state = at(JointId::kLeftFoot).state = JointState::kLost;
  const auto places = known_places(person, Mat3());
  ASSERT_TRUE(places);
  const auto expect = [&](JointId id, Vec3 want) {
    EXPECT_NEAR(norm((*places)[static_cast<std::size_t>(id)] - want), 0, 1e-12) << name_of(id);
  };
  expect(JointId::kLeftKnee, {0.1, 0.4, 2});
  expect(JointId::kLeftAnkle, {0.1, 0.81, 2});    // the shin of an adult below the knee
  expect(JointId::kLeftFoot, {0.1, 0.81, 1.84});  // and the foot towards where the person looks
  at(JointId::kChest).state = JointState::kLost;
  EXPECT_FALSE(known_places(person, Mat3()));
  person.skeleton = &kRightArm;  // of an arm nothing may be lost
  person.joints[2].state = JointState::kLost;
  EXPECT_FALSE(known_places(person, Mat3()));
}

/// By hand: lost fingers of a hand that hangs go on downwards, the thumb to the front; the index finger's root lies 92 mm below
/// the wrist and 25 mm before it, its tip 87 mm below that.
TEST(KnownPlaces, LostFingersGoOnWithTheHand) {
  Person person;
  person.skeleton = &kBodyHands;
  for (std::size_t j = 0; j < kBodyJointIds; ++j) person.joints[j].state = JointState::kSeen;
  const auto at = [&](JointId id) -> Joint& { return person.joints[static_cast<std::size_t>(id)]; };
  at(JointId::kChest).p_in_rig_m = {0, -0.5, 2};
  at(JointId::kPelvis).p_in_rig_m = {0, 0, 2};
  at(JointId::kLeftShoulder).p_in_rig_m = {0.2, -0.5, 2};
  at(JointId::kRightShoulder).p_in_rig_m = {-0.2, -0.5, 2};
  at(JointId::kLeftWrist).p_in_rig_m = {0.3, 0, 2};
  at(JointId::kLeftHand).p_in_rig_m = {0.3, 0.07, 2};
  const auto places = known_places(person, Mat3());
  ASSERT_TRUE(places);
  const auto expect = [&](JointId id, Vec3 want) {
    EXPECT_NEAR(norm((*places)[static_cast<std::size_t>(id)] - want), 0, 1e-12) << name_of(id);
  };
  expect(JointId::kLeftIndexMcp, {0.3, 0.092, 1.975});
  expect(JointId::kLeftIndexTip, {0.3, 0.179, 1.975});
}

TEST(BoneTurns, NoneInTheTPose) {
  for (const Skeleton* skeleton : {&kBody, &kBodyHands}) {
    const auto turns = BoneTurner(*skeleton, BodyAxes::kRightHanded).turn(t_pose(*skeleton));
    ASSERT_TRUE(turns);
    for (std::size_t j = 0; j < turns->size(); ++j) expect_turn((*turns)[j], Mat3{}, std::string(skeleton->joints[j].name));
  }
}

/// By hand: the left index finger's middle bone points down where the palm looks: a quarter turn around z, and nothing else.
TEST(BoneTurns, AFingerBendsToThePalm) {
  std::vector<Vec3> places = t_pose(kBodyHands);
  const auto at = [](JointId id) { return static_cast<std::size_t>(id); };
  places[at(JointId::kLeftIndexDip)] = places[at(JointId::kLeftIndexPip)] + Vec3{0, -0.2, 0};
  places[at(JointId::kLeftIndexTip)] = places[at(JointId::kLeftIndexDip)] + Vec3{0, -0.2, 0};
  const auto turns = BoneTurner(kBodyHands, BodyAxes::kRightHanded).turn(places);
  ASSERT_TRUE(turns);
  expect_turn((*turns)[at(JointId::kLeftIndexMcp)], Mat3{}, "root");
  expect_turn((*turns)[at(JointId::kLeftIndexPip)], Mat3{{0, 1, 0, -1, 0, 0, 0, 0, 1}}, "middle");
  expect_turn((*turns)[at(JointId::kLeftIndexDip)], Mat3{}, "end");
}

/// By hand: a shin that points to the back has turned a quarter around x, and its foot, which went with it, has not.
TEST(BoneTurns, AKneeBendsAroundItsHinge) {
  std::vector<Vec3> places = t_pose();
  const auto at = [](JointId id) { return static_cast<std::size_t>(id); };
  places[at(JointId::kLeftAnkle)] = places[at(JointId::kLeftKnee)] + Vec3{0, 0, -0.2};
  places[at(JointId::kLeftFoot)] = places[at(JointId::kLeftAnkle)] + Vec3{0, -0.2, 0};
  const auto turns = BoneTurner(kBody, BodyAxes::kRightHanded).turn(places);
  ASSERT_TRUE(turns);
  expect_turn((*turns)[at(JointId::kLeftHip)], Mat3{}, "hip");
  expect_turn((*turns)[at(JointId::kLeftKnee)], Mat3{{1, 0, 0, 0, 0, -1, 0, 1, 0}}, "knee");
  expect_turn((*turns)[at(JointId::kLeftAnkle)], Mat3{}, "ankle");
}

/// By hand: an upper arm 5 cm too long leads 5 cm beyond the elbow; the forearm then points back to the wrist below it, and
/// ends sqrt(0.05^2 + 0.2^2) - 0.2 m from it instead of 5 cm.
TEST(BoneTurns, ABoneOfAnotherLengthDoesNotMoveTheNextOnesEnd) {
  std::vector<Vec3> places = t_pose();
  const auto at = [](JointId id) { return static_cast<std::size_t>(id); };
  places[at(JointId::kLeftWrist)] = places[at(JointId::kLeftElbow)] + Vec3{0, -0.2, 0};
  places[at(JointId::kLeftHand)] = places[at(JointId::kLeftWrist)] + Vec3{0, -0.2, 0};
  std::vector<double> lengths(places.size(), 0.2);
  lengths[at(JointId::kLeftElbow)] = 0.25;
  const auto turns = BoneTurner(kBody, BodyAxes::kRightHanded).turn(places, lengths);
  ASSERT_TRUE(turns);
  std::vector<Vec3> reached(places.size(), places[0]);
  std::vector<Mat3> whole = *turns;
  for (std::size_t j = 1; j < places.size(); ++j) {
    const auto parent = static_cast<std::size_t>(kBody.joints[j].parent);
    reached[j] = reached[parent] + whole[parent] * (lengths[j] * rest_direction(kBody.joints[j].id, BodyAxes::kRightHanded));
    whole[j] = whole[parent] * whole[j];
  }
  const auto off = [&](JointId id) { return norm(reached[at(id)] - places[at(id)]); };
  EXPECT_NEAR(off(JointId::kLeftElbow), 0.05, 1e-9);
  EXPECT_NEAR(off(JointId::kLeftWrist), 0.0061553, 1e-6);
  EXPECT_NEAR(off(JointId::kRightHand), 0, 1e-9);
}

/// A whole body that turns does so at its root alone.
TEST(BoneTurns, TheRootTurnsWithTheBody) {
  const Mat3 quarter = {{0, 0, 1, 0, 1, 0, -1, 0, 0}};
  std::vector<Vec3> places = t_pose();
  for (Vec3& p : places) p = quarter * p;
  const auto turns = BoneTurner(kBody, BodyAxes::kRightHanded).turn(places);
  ASSERT_TRUE(turns);
  expect_turn((*turns)[0], quarter, "pelvis");
  for (std::size_t j = 1; j < turns->size(); ++j) expect_turn((*turns)[j], Mat3{}, std::string(kBody.joints[j].name));
  places[1] = places[0];
  EXPECT_FALSE(BoneTurner(kBody, BodyAxes::kRightHanded).turn(places)) << "two joints at one place";
}

}  // namespace
}  // namespace duo
