#include <gtest/gtest.h>

#include "body/bone_turns.h"
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

/// Places of a body in its T-pose, each bone 0.2 long.
std::vector<Vec3> t_pose() {
  std::vector<Vec3> out(kBody.joints.size());
  for (std::size_t j = 1; j < out.size(); ++j)
    out[j] = out[static_cast<std::size_t>(kBody.joints[j].parent)] +
             0.2 * rest_direction(kBody.joints[j].id, BodyAxes::kRightHanded);
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

TEST(BoneTurns, NoneInTheTPose) {
  const auto turns = BoneTurner(kBody, BodyAxes::kRightHanded).turn(t_pose());
  ASSERT_TRUE(turns);
  for (std::size_t j = 0; j < turns->size(); ++j) expect_turn((*turns)[j], Mat3{}, std::string(kBody.joints[j].name));
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
