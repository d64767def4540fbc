// Which surfaces carry the joints of a made-up person.
#include <gtest/gtest.h>

#include "trackers/body/behind_back.h"
#include "trackers/body/standing.h"

namespace duo::body {
namespace {

using namespace test;  // NOLINT: the made-up person

TEST(BodyChoose, EveryJointStandsOnItsSurface) {
  const Places places = standing();
  Standing s(places);
  Choices chosen;
  choose(s.scene, chosen);
  for (const JointId id : kFreeJoints) {
    EXPECT_TRUE(chosen[id].on_surface) << name_of(id);
    EXPECT_LT(distance(chosen[id].p, places[id]), 0.005) << name_of(id);
  }
}

TEST(BodyChoose, TheSurfaceThatFitsTheBonesWinsOverTheMedian) {
  const Places places = standing();
  Standing s(places);
  const double skin = s.scene.surfaces[kLeftElbow].all[0].z_m;
  s.put(kLeftElbow, {{skin - 0.5, 0.55}, {skin, 0.25}, {skin + 0.4, 0.2}});
  Choices chosen;
  choose(s.scene, chosen);
  EXPECT_TRUE(chosen[kLeftElbow].on_surface);
  EXPECT_LT(distance(chosen[kLeftElbow].p, places[kLeftElbow]), 0.005);
}

TEST(BodyChoose, AHandMarkedOnItsForearmBehindTheTrunkIsHidden) {
  // The left forearm goes behind the trunk, 14 cm from its middle, where the network of bodies marks the hand as well.
  Places places = standing();
  places[kLeftElbow] = {0.25, -0.19, 2.05};
  places[kLeftWrist] = {0.08, -0.05, 2.13};
  places[kLeftHand] = {0.03, -0.01, 2.14};
  Standing s(places);
  for (const JointId id : {kLeftWrist, kLeftHand}) {
    s.scene.points[id].at_px = s.scene.depth.geometry->project({0.14, -0.1, 2.1});
    s.put(id, {{2.08, 0.5}});
  }
  const auto shown = [&](HandSight sight) {
    s.scene.hands[0] = sight;
    Choices chosen;
    choose(s.scene, chosen);
    return chosen[kLeftHand].on_surface;
  };
  EXPECT_FALSE(shown(HandSight::kAbsent));
  EXPECT_TRUE(shown(HandSight::kSeen));
}

TEST(BodyChoose, AHandBehindTheTrunkLiesOnTheBack) {
  // 22.5 cm below the shoulders, 0.4891 of the trunk's length, the back is 0.2706 widths behind the plane of shoulders and
  // hips, and a wrist's centre 3 cm more: 0.1234 m.
  Standing s(standing());
  s.scene.hands[0] = HandSight::kAbsent;
  const auto off = [&](Vec3 p) { return s.scene.off_back_m(kLeftWrist, p); };
  ASSERT_TRUE(off({0.05, -0.2, 2.2}));
  EXPECT_NEAR(*off({0.05, -0.2, 2.2}), 0.0766, 1e-4);
  EXPECT_NEAR(*off({0.05, -0.2, 2.05}), -0.0734, 1e-4);
  EXPECT_FALSE(off({0.05, -0.2, 1.9}));                             // before the trunk
  EXPECT_FALSE(off({0.3, -0.2, 2.2}));                              // beside it
  EXPECT_FALSE(s.scene.off_back_m(kLeftElbow, {0.05, -0.2, 2.2}));  // elbows stand off
  s.scene.hands[0] = HandSight::kSeen;
  EXPECT_FALSE(off({0.05, -0.2, 2.2}));
  s.scene.hands[0] = HandSight::kAbsent;
  s.scene.trunk.front = {0, 0, 1};  // who shows the back
  EXPECT_FALSE(off({0.05, -0.2, 2.2}));
}

TEST(BodyChoose, AHandBehindTheTrunkIsAForearmAndAPalmFromItsElbow) {
  // 23.5 cm below the shoulders the back's depth is 2.1247 m for a wrist, the left elbow is 0.0747 m before it: of the
  // forearm's 0.238 m 0.2260 m lie along the back, of forearm and palm, 0.306 m, 0.2967 m. The network marks wrist and hand
  // where the forearm goes in, 10 cm from the elbow, to the middle and down as 2 to 1.
  const Vec3 elbow = {0.25, -0.19, 2.05}, along = {-0.894427, 0.447214, 0};
  const auto on_the_back = [&](double way) { return Vec3{0.25, -0.19, 2.1247} + way * along; };
  Places places = standing();
  places[kLeftElbow] = elbow;
  Standing s(places);
  s.scene.hands[0] = HandSight::kAbsent;
  for (const JointId id : {kLeftWrist, kLeftHand}) {
    s.scene.points[id].at_px = s.scene.depth.geometry->project(on_the_back(0.1));
    s.scene.expected[id] = {on_the_back(id == kLeftWrist ? 0.15 : 0.218), 0.2, 10};
    s.put(id, {{1.9, 1}});  // the trunk
  }
  const auto wrist = on_back(s.scene, kLeftWrist, elbow, 0.238);
  ASSERT_TRUE(wrist);
  EXPECT_LT(distance(*wrist, on_the_back(0.2260)), 1e-4);
  Choices chosen;
  choose(s.scene, chosen);
  EXPECT_TRUE(chosen[kLeftElbow].on_surface);
  EXPECT_LT(distance(chosen[kLeftWrist].p, on_the_back(0.2260)), 0.01);
  EXPECT_LT(distance(chosen[kLeftHand].p, on_the_back(0.2967)), 0.01);

  // The mark, 12.6 cm from the wrist, counts little: believed as other hidden ones are, it would pull the wrist by centimetres.
  Fitted fitted;
  Fit().run(s.scene, chosen, {}, fitted);
  EXPECT_LT(distance(fitted.places[kLeftWrist], on_the_back(0.2260)), 0.012);
  EXPECT_LT(distance(fitted.places[kLeftElbow], elbow), 0.012);

  EXPECT_FALSE(on_back(s.scene, kLeftWrist, {0.25, -0.19, 1.8}, 0.238));  // 31 cm before the back
  EXPECT_FALSE(on_back(s.scene, kLeftWrist, {0.45, -0.19, 2.05}, 0.1));   // beside the trunk
  s.scene.hands[0] = HandSight::kNotAsked;
  EXPECT_FALSE(on_back(s.scene, kLeftWrist, elbow, 0.238));
}

TEST(BodyChoose, AWristBehindTheTrunkIsNotMarkedOnItsUpperArm) {
  // The left wrist was behind the trunk in the last frame. Its mark lies in the middle of the upper arm, 5 cm thick to each
  // side, or 6 cm beside.
  const Places places = standing();
  const Vec3 upper_arm = middle(places[kLeftShoulder], places[kLeftElbow]), last = {0.05, -0.1, 2.12};
  const auto marked = [&](Vec3 mark, Vec3 expected, HandSight sight) {
    Standing s(places);
    s.scene.hands[0] = sight;
    s.scene.expected[kLeftWrist].p = expected;
    s.scene.points[kLeftWrist].at_px = s.scene.depth.geometry->project(mark);
    leave_upper_arm(s.scene, kArmChains[0]);
    return s.scene.points[kLeftWrist];
  };
  const Rectified camera = geometry();
  const Point left = marked(upper_arm, last, HandSight::kAbsent);
  EXPECT_LT(distance(left.at_px, camera.project(last)), 1e-9);
  EXPECT_LE(left.visibility, 0.1);
  EXPECT_TRUE(left.inside);
  const auto stays = [&](Vec3 mark, Vec3 expected, HandSight sight) {
    EXPECT_LT(distance(marked(mark, expected, sight).at_px, camera.project(mark)), 1e-9);
  };
  stays(upper_arm + Vec3{0.06, 0, 0}, last, HandSight::kAbsent);
  stays(upper_arm, {0.05, -0.1, 1.8}, HandSight::kAbsent);  // before the trunk
  stays(upper_arm, last, HandSight::kSeen);
}

TEST(BodyChoose, InProfileTheFarShoulderIsInferredBehindTheNearOne) {
  // Turned by 90 degrees: the left side is near, and both shoulders are marked on it.
  Places places = standing();
  for (const JointId id : kFreeJoints) {
    const Vec3 p = places[id];
    places[id] = {p.z - 2, p.y, 2 - p.x};
  }
  Standing s(places, {0, 0, -1});
  const double near_skin = s.scene.surfaces[kLeftShoulder].all[0].z_m;
  s.put(kRightShoulder, {{near_skin, 1}});
  for (const JointId id : {kLeftShoulder, kRightShoulder}) s.scene.expected[id].hidden = 10;
  Choices chosen;
  choose(s.scene, chosen);
  EXPECT_TRUE(chosen[kLeftShoulder].on_surface);
  EXPECT_FALSE(chosen[kRightShoulder].on_surface);
  EXPECT_NEAR(chosen[kRightShoulder].p.z - chosen[kLeftShoulder].p.z, s.lengths[Bone::kShoulders], 0.03);
}

TEST(BodyChoose, ANearHipIsNotHiddenByTheFarOne) {
  // Half turned, the left side far; both hips are marked on the near one's skin, and the far one is expected there as well.
  Places places = standing();
  places[kLeftHip] = {0.05, 0.035, 2.09};
  places[kRightHip] = {-0.05, 0.035, 1.91};
  Standing s(places, {0.5, 0, 0.866});
  const Surface near = s.scene.surfaces[kRightHip].all[0];
  s.put(kLeftHip, {near});
  for (const JointId id : {kLeftHip, kRightHip}) s.scene.expected[id] = {places[id] - Vec3{0, 0, 0.06}, 0.1, 10};
  Choices chosen;
  choose(s.scene, chosen);
  EXPECT_TRUE(chosen[kRightHip].on_surface);
  EXPECT_FALSE(chosen[kLeftHip].on_surface);
  EXPECT_LT(distance(chosen[kRightHip].p, places[kRightHip]), 0.005);
}

TEST(BodyChoose, OfWhoSitsTheThighsHideTheHips) {
  // Thighs towards the cameras: at the hips' points lies the lap, 12 cm before where hips have their skin.
  Places places = standing();
  for (const double side : {1.0, -1.0}) {
    const Limb& leg = kLegChains[side > 0 ? 0 : 1];
    places[leg[1]] = {side * 0.11, 0.1, 1.605};
    places[leg[2]] = {side * 0.11, 0.51, 1.605};
    places[leg[3]] = {side * 0.12, 0.55, 1.46};
  }
  Standing s(places);
  for (int i = 0; i < 200; ++i) s.lengths.learn(Bone::kThigh, 0.4, 1);
  for (const JointId id : {kLeftHip, kRightHip}) {
    s.put(id, {{s.scene.surfaces[id].all[0].z_m - 0.12, 1}});
    s.scene.points[id].visibility = 0.5;
    s.scene.expected[id] = {places[id], 0.2, 10};
  }
  Choices chosen;
  choose(s.scene, chosen);
  for (const JointId id : {kLeftHip, kRightHip}) {
    EXPECT_FALSE(chosen[id].on_surface) << name_of(id);
    EXPECT_LT(distance(chosen[id].p, places[id]), 0.04) << name_of(id);
  }
}

TEST(BodyChoose, WhatStandsBeforeTheHipsAloneIsNoTrunk) {
  // A plant 40 cm before the hips, which have been hidden for a while; their places are vague.
  const Places places = standing();
  Standing s(places);
  for (int i = 0; i < 200; ++i) s.lengths.learn(Bone::kTrunk, 0.46, 1);
  for (const JointId id : {kLeftHip, kRightHip}) {
    s.put(id, {{s.scene.surfaces[id].all[0].z_m - 0.4, 1}});
    s.scene.expected[id] = {places[id], 0.3, 20};
  }
  Choices chosen;
  choose(s.scene, chosen);
  for (const JointId id : {kLeftHip, kRightHip}) EXPECT_FALSE(chosen[id].on_surface) << name_of(id);
}

TEST(BodyChoose, NoSurfaceCarriesTwoKnees) {
  // Legs crossed: both knees are marked at one place, and its surface is the left one's.
  Places places = standing();
  places[kLeftKnee] = {0, 0.44, 1.95};
  places[kRightKnee] = {0, 0.44, 2.1};
  Standing s(places);
  s.put(kRightKnee, {s.scene.surfaces[kLeftKnee].all[0]});
  Choices chosen;
  choose(s.scene, chosen);
  EXPECT_TRUE(chosen[kLeftKnee].on_surface);
  EXPECT_FALSE(chosen[kRightKnee].on_surface);
}

TEST(BodyChoose, AKneeIsNotOnTheOtherThigh) {
  Places places = standing();
  places[kLeftKnee] = {-0.108, 0.3, 2.25};  // behind the right thigh
  Standing s(places);
  s.scene.expected[kLeftKnee].hidden = 10;
  s.put(kLeftKnee, {{2 - depth_of_joint_m(s.scene, kLeftKnee, 2), 1}});
  Choices chosen;
  choose(s.scene, chosen);
  EXPECT_TRUE(chosen[kRightKnee].on_surface);
  EXPECT_FALSE(chosen[kLeftKnee].on_surface);
  s.put(kRightKnee, {});  // without a right leg the surface is its own
  choose(s.scene, chosen);
  EXPECT_TRUE(chosen[kLeftKnee].on_surface);
}

TEST(BodyChoose, AnElbowIsNotOnSomebodyElse) {
  const Places places = standing();
  Places other;  // 10 cm nearer, at the same places of the picture
  for (const JointId id : kFreeJoints) other[id] = 0.95 * places[id];
  complete(other);
  Standing s(places);
  s.scene.expected[kRightElbow].hidden = 10;
  s.put(kRightElbow, {{1.9 - depth_of_joint_m(s.scene, kRightElbow, 1.9), 1}});
  Choices chosen;
  choose(s.scene, chosen);
  EXPECT_TRUE(chosen[kRightElbow].on_surface);
  const std::array<const Places*, 1> nearer = {&other};
  s.scene.nearer = nearer;
  choose(s.scene, chosen);
  EXPECT_FALSE(chosen[kRightElbow].on_surface);
}

TEST(BodyChoose, AnArmThatTheNetworkSaysIsHiddenIsOnNoSurface) {
  Standing s(standing());
  for (const JointId id : {kLeftElbow, kLeftWrist, kLeftHand}) {
    s.scene.points[id].visibility = 0.1;
    s.scene.expected[id].hidden = 10;
  }
  Choices chosen;
  choose(s.scene, chosen);
  for (const JointId id : {kLeftElbow, kLeftWrist, kLeftHand}) EXPECT_FALSE(chosen[id].on_surface) << name_of(id);
  s.scene.hands[0] = HandSight::kSeen;  // its own network knows better
  choose(s.scene, chosen);
  EXPECT_FALSE(chosen[kLeftElbow].on_surface);
  EXPECT_TRUE(chosen[kLeftWrist].on_surface);
  EXPECT_TRUE(chosen[kLeftHand].on_surface);
}

TEST(BodyChoose, AHandBehindTheBackIsNotOnTheBelly) {
  Places places = standing();
  places[kLeftElbow] = {0.26, -0.2, 2.08};
  places[kLeftWrist] = {0.05, -0.17, 2.2};
  places[kLeftHand] = {-0.01, -0.15, 2.2};
  Standing s(places);
  const Vec3 belly = {0, -0.17, 2 - 0.33 * s.lengths[Bone::kShoulders]};
  const double above = *s.map.height_m(s.scene.trunk, belly, s.lengths[Bone::kShoulders]);
  for (const JointId id : {kLeftWrist, kLeftHand}) s.put(id, {{2 - above, 1}});
  s.scene.hands[0] = HandSight::kAbsent;
  Choices chosen;
  choose(s.scene, chosen);
  EXPECT_FALSE(chosen[kLeftHand].on_surface);
  EXPECT_FALSE(chosen[kLeftWrist].on_surface);
  EXPECT_GT(chosen[kLeftHand].p.z, 2.08);
  // The same surface 12 cm before the belly is the hand.
  for (const JointId id : {kLeftElbow, kLeftWrist, kLeftHand}) s.scene.expected[id] = {places[id] - Vec3{0, 0, 0.35}, 0.1, 0};
  s.put(kLeftElbow, {{1.85, 1}});
  for (const JointId id : {kLeftWrist, kLeftHand}) s.put(id, {{2 - above - 0.12, 1}});
  s.scene.hands[0] = HandSight::kSeen;
  choose(s.scene, chosen);
  EXPECT_TRUE(chosen[kLeftHand].on_surface);
}

}  // namespace
}  // namespace duo::body
