// The steps of the body tracker against numbers worked out by hand.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "trackers/body/fit.h"
#include "trackers/body/seen_trunk.h"
#include "trackers/body/standing.h"

namespace duo::body {
namespace {

using namespace test;  // NOLINT: the made-up person

TEST(BodyLift, AWindowOverTwoSurfacesGivesBothNearestFirst) {
  Map map;
  map.fill({100, 0, 60, 240}, 2.5);
  map.fill({160, 0, 60, 240}, 2.0);
  const Surfaces both = surfaces_at(map.view(), {159.5, 120}, 2, 0.05, {1, 4});
  ASSERT_EQ(both.count, 2u);
  EXPECT_NEAR(both.all[0].z_m, 2.0, 0.01);
  EXPECT_NEAR(both.all[1].z_m, 2.5, 0.01);
  EXPECT_NEAR(both.all[0].share + both.all[1].share, 1, 1e-9);
  EXPECT_EQ(surfaces_at(map.view(), {159.5, 120}, 2, 0.05, {2.2, 4}).count, 1u);  // the near one is out of range
  EXPECT_EQ(surfaces_at(map.view(), {20, 120}, 2, 0.05, {1, 4}).count, 0u);       // nothing is known there
  EXPECT_EQ(surfaces_at(map.view(), {-500, 1e9}, 2, 0.05, {1, 4}).count, 0u);
}

TEST(BodyLift, AGapBelowTwoCentimetresIsOneSurface) {
  Map map;
  map.fill({100, 0, 60, 240}, 1.01);
  map.fill({160, 0, 60, 240}, 1.0);
  EXPECT_EQ(surfaces_at(map.view(), {159.5, 120}, 1, 0.05, {0.5, 4}).count, 1u);
}

TEST(BodyLift, TheTrunksDepthIsItsMedian) {
  Map map;
  map.fill({120, 60, 80, 120}, 2.0);
  map.fill({120, 60, 25, 120}, 1.5);  // an arm before a third of it
  EXPECT_NEAR(trunk_depth(map.view(), {Vec2{200, 60}, Vec2{120, 60}, Vec2{200, 180}, Vec2{120, 180}}, {0.5, 5}), 2.0, 0.01);
  EXPECT_EQ(trunk_depth(map.view(), {Vec2{60, 60}, Vec2{10, 60}, Vec2{60, 180}, Vec2{10, 180}}, {0.5, 5}), 0);
}

TEST(BodyLengths, AreLearntWithinFifteenPercentOfAnAdults) {
  Lengths lengths;
  const double adult = lengths[Bone::kUpperArm];
  const double doubt = lengths.sigma_m(Bone::kUpperArm);
  for (int i = 0; i < 100; ++i) lengths.learn(Bone::kUpperArm, adult * (i % 2 ? 1.09 : 1.11), 1);
  // The weighted median of 100 samples, beside six of the prior.
  EXPECT_NEAR(lengths[Bone::kUpperArm], adult * (100 * 1.10 + 6) / 106, 0.012 * adult);
  EXPECT_LT(lengths.sigma_m(Bone::kUpperArm), doubt / 3);
  for (int i = 0; i < 300; ++i) lengths.learn(Bone::kUpperArm, 1.29 * adult, 1);
  EXPECT_NEAR(lengths[Bone::kUpperArm], 1.15 * adult, 1e-9);
  lengths.learn(Bone::kThigh, 3, 1);  // nobody's
  EXPECT_EQ(lengths[Bone::kThigh], Lengths()[Bone::kThigh]);
}

/// A length that was learnt for a second stays while what is measured drifts by 3 mm, and not while it drifts by 20.
TEST(BodyLengths, AreKeptUntilTheyAreWrong) {
  Lengths lengths;
  const double adult = lengths[Bone::kShin];
  lengths.learn(Bone::kShin, 1.05 * adult, 1);
  EXPECT_EQ(lengths.kept(Bone::kShin), lengths[Bone::kShin]) << "not yet learnt";
  for (int i = 0; i < 60; ++i) lengths.learn(Bone::kShin, 1.05 * adult, 1);
  const double kept = lengths.kept(Bone::kShin);
  EXPECT_NEAR(kept, (49 * 1.05 + 6) / 55 * adult, 1e-6);
  for (int i = 0; i < 200; ++i) lengths.learn(Bone::kShin, 1.05 * adult + 0.003, 1);
  EXPECT_GT(lengths[Bone::kShin], kept + 0.004);
  EXPECT_EQ(lengths.kept(Bone::kShin), kept);
  for (int i = 0; i < 200; ++i) lengths.learn(Bone::kShin, 1.05 * adult + 0.02, 1);
  EXPECT_GT(lengths.kept(Bone::kShin), kept + 0.008);
}

TEST(BodyLengths, WhatWasMeasuredTooShortIsLengthened) {
  Lengths late, early;
  const double adult = late[Bone::kTrunk];
  for (int i = 0; i < 50; ++i) late.learn(Bone::kTrunk, adult + 0.02, 1), early.learn(Bone::kTrunk, adult, 1);
  early.lengthen(Bone::kTrunk, 0.02);
  EXPECT_NEAR(early[Bone::kTrunk], late[Bone::kTrunk], 1e-6);
  late.learn(Bone::kTrunk, adult + 0.02, 1), early.learn(Bone::kTrunk, adult + 0.02, 1);
  EXPECT_NEAR(early[Bone::kTrunk], late[Bone::kTrunk], 1e-6);
  early.lengthen(Bone::kTrunk, 0.07);  // within 15 % of an adult's, as what is learnt
  EXPECT_NEAR(early[Bone::kTrunk], 1.15 * adult, 1e-9);
}

TEST(BodyLengths, TrunkAndThighTellHowLowHipsAreMarked) {
  // An adult's trunk and thigh, 0.465 and 0.405 m, between hips that are marked 3 cm too low; the marks go up meanwhile.
  HipMark mark;
  for (int i = 0; i < 200; ++i) mark.learn(0.465 + 0.03 - mark.low_m(), 0.405 - 0.03 + mark.low_m(), mark.low_m());
  EXPECT_NEAR(mark.low_m(), 0.85 * 0.03 * 200 / 206, 1e-9);
  // Nor does it move for another size of the same person, or without end.
  HipMark child, other;
  for (int i = 0; i < 200; ++i) child.learn(0.7 * 0.465, 0.7 * 0.405, child.low_m());
  EXPECT_NEAR(child.low_m(), 0, 1e-9);
  for (int i = 0; i < 200; ++i) other.learn(0.3, 0.5, other.low_m());
  EXPECT_EQ(other.low_m(), -0.04);
}

TEST(BodyEquations, TwoPointsAtADistanceByHand) {
  // Point 0 is at 0 and held there with sigma 1; point 1 at 3 on x, held with sigma 1; the distance should be 1 with sigma 1/2.
  // x0² + (x1 - 3)² + 4 (x1 - x0 - 1)²: x0 = 8/9, x1 = 19/9.
  PointEquations<2> e;
  const auto hold = [&](std::size_t point, Vec3 off) {
    e.add(off.x, std::array{Slope{point, {1, 0, 0}}});
    e.add(off.y, std::array{Slope{point, {0, 1, 0}}});
    e.add(off.z, std::array{Slope{point, {0, 0, 1}}});
  };
  hold(0, {});
  hold(1, {});
  e.add(2 * (3 - 1), std::array{Slope{1, {2, 0, 0}}, Slope{0, {-2, 0, 0}}});
  ASSERT_TRUE(e.factor());
  const auto step = e.step();
  EXPECT_NEAR(step[0].x, 8.0 / 9, 1e-12);
  EXPECT_NEAR(step[1].x, -8.0 / 9, 1e-12);
  EXPECT_NEAR(step[1].y, 0, 1e-12);
  EXPECT_NEAR(e.covariance(0)[0], 5.0 / 9, 1e-12);  // of the inverse of (5 -4; -4 5)
  EXPECT_NEAR(e.covariance(0)[3], 1, 1e-12);
  e.clear();
  EXPECT_FALSE(e.factor());  // nothing says where they are
}

SeenBody upright(Vec2 middle_px, double px_per_m) {
  SeenBody body;
  const auto put = [&](BodyPoint point, double x_m, double y_m) {
    SeenPoint& p = body.points[static_cast<std::size_t>(point)];
    p.x_q8 = static_cast<std::int32_t>(256 * (middle_px.x + px_per_m * x_m));
    p.y_q8 = static_cast<std::int32_t>(256 * (middle_px.y + px_per_m * y_m));
    p.world_q16 = {static_cast<std::int32_t>(65536 * x_m), static_cast<std::int32_t>(65536 * y_m), 0};
    p.visible_q15 = 32768;
  };
  put(BodyPoint::kLeftShoulder, 0.2, -0.4);
  put(BodyPoint::kRightShoulder, -0.2, -0.4);
  put(BodyPoint::kLeftHip, 0.1, 0.1);
  put(BodyPoint::kRightHip, -0.1, 0.1);
  put(BodyPoint::kLeftElbow, 0.2, -0.15);
  put(BodyPoint::kLeftKnee, 0.1, 0.5);
  body.next = {0, 0, 256 * 128, 0};  // half a side of 128 px: 1 px of the crop is 1 px
  return body;
}

TEST(BodyPoints, JointsLieBesideTheMarks) {
  const auto points_with = [](double ahead_m, double hips_low_m) {
    return points_of(upright({100, 100}, 100), BodyModel::kLite, {320, 240}, 100, 0.4, ahead_m, hips_low_m);
  };
  const Points points = points_with(0, 0);
  // Down the trunk by 0.053 of 0.4 m at 100 px a metre, outwards by 0.033 of the 40 px between the shoulders.
  EXPECT_NEAR(points[kLeftShoulder].at_px.y, 60 + 2.12, 0.01);
  EXPECT_NEAR(points[kLeftShoulder].at_px.x, 120 + 1.32, 0.01);
  EXPECT_NEAR(points[kRightShoulder].at_px.x, 80 - 1.32, 0.01);
  EXPECT_NEAR(points[kLeftHip].at_px.y, 110 - 3.4, 0.01);
  EXPECT_NEAR(points[kLeftShoulder].sigma_px, 1.5, 1e-9);
  EXPECT_TRUE(points[kLeftShoulder].inside);
  // What is marked 3 cm too far to the right and 2 cm too low goes back by 3 and 2 px; only hips are marked too low.
  const Points back = points_with(0.03, 0.02);
  EXPECT_NEAR(back[kLeftHip].at_px.x, points[kLeftHip].at_px.x - 3, 0.01);
  EXPECT_NEAR(back[kRightHip].at_px.y, points[kRightHip].at_px.y - 2, 0.01);
  EXPECT_NEAR(back[kHead].at_px.x, points[kHead].at_px.x - 3, 0.01);
  EXPECT_NEAR(back[kHead].at_px.y, points[kHead].at_px.y, 0.01);
  EXPECT_EQ(back[kLeftShoulder].at_px.x, points[kLeftShoulder].at_px.x);
  // 1 % of an upper arm of 25 cm back to the shoulder's mark, 3 % of a thigh of 40 cm to the hip's.
  EXPECT_NEAR(points[kLeftElbow].at_px.y, 85 - 0.25, 0.01);
  EXPECT_NEAR(points[kLeftKnee].at_px.y, 150 - 1.2, 0.01);
}

TEST(BodyPoints, AnArmLiftedToItsSideTakesItsShoulderAlong) {
  SeenBody body = upright({100, 100}, 100);
  auto& elbow = body.points[static_cast<std::size_t>(BodyPoint::kLeftElbow)];
  EXPECT_EQ(lifted(body, true, 40), 0);
  elbow.x_q8 = 256 * 135, elbow.y_q8 = 256 * 80;  // by 0.6 of the 25 px outwards
  EXPECT_NEAR(lifted(body, true, 40), 0.5, 1e-9);
  EXPECT_EQ(lifted(body, true, 60), 0);  // 0.4 of them, if the trunk is turned so far that its 60 px show as 40
  const Points points = points_of(body, BodyModel::kLite, {320, 240}, 100, 0.4, 0, 0);
  EXPECT_NEAR(points[kLeftShoulder].at_px.y, 60 + 2.12 - 0.6, 0.01);  // half of 0.03 of 0.4 m
}

TEST(BodyTrunk, SidesAreExchangedWhereTheOtherSidesAreExpected) {
  const SeenBody body = upright({100, 100}, 100), exchanged = with_sides_exchanged(body);
  EXPECT_EQ(exchanged.at(BodyPoint::kLeftHip).x_px(), body.at(BodyPoint::kRightHip).x_px());
  EXPECT_EQ(exchanged.at(BodyPoint::kRightShoulder).world_m().x, body.at(BodyPoint::kLeftShoulder).world_m().x);
  const TrunkCorners expected = corners_of(body);
  EXPECT_FALSE(are_sides_exchanged(corners_of(body), expected));
  EXPECT_TRUE(are_sides_exchanged(corners_of(exchanged), expected));
  // From the side the shoulders are 8 px apart beside a trunk of 50: the network may turn the person as it likes.
  TrunkCorners aside = expected;
  aside[0].x = 104;
  aside[1].x = 96;
  EXPECT_FALSE(are_sides_exchanged(corners_of(exchanged), aside));
  // Half a trunk away nothing is nearer to one side than to the other.
  TrunkCorners away = corners_of(exchanged);
  for (Vec2& corner : away) corner.x += 25;
  EXPECT_FALSE(are_sides_exchanged(away, expected));
}

TEST(BodyTrunk, EveryPointButTheNoseHasAnotherSide) {
  SeenBody body;
  for (std::size_t i = 0; i < kBodyPoints; ++i) body.points[i].x_q8 = static_cast<std::int32_t>(i);
  const SeenBody exchanged = with_sides_exchanged(body);
  EXPECT_EQ(exchanged.at(BodyPoint::kNose).x_q8, 0);
  for (std::size_t i = 1; i < kBodyPoints; ++i) {
    const std::string name(name_of(static_cast<BodyPoint>(i)));
    const std::string other(name_of(static_cast<BodyPoint>(exchanged.points[i].x_q8)));
    const auto left = name.find("left"), right = name.find("right");
    ASSERT_NE(left == std::string::npos, right == std::string::npos) << name;
    const std::string opposite =
        left != std::string::npos ? std::string(name).replace(left, 4, "right") : std::string(name).replace(right, 5, "left");
    EXPECT_EQ(other, opposite);
  }
}

TEST(BodyPoints, AHandsNetworkMovesHandAndWristAndTheShiftStays) {
  SeenHand hand;
  hand.points[0].x_q8 = 256 * 50;
  hand.points[9].x_q8 = 256 * 70;
  Points points;
  points[kLeftWrist].at_px = {48, 1};
  points[kLeftHand].at_px = {60, 0};
  const HandShift shift = take_hand(hand, true, points);
  EXPECT_NEAR(points[kLeftHand].at_px.x, 63, 1e-9);  // 65 % of the way from 50 to 70
  EXPECT_NEAR(points[kLeftWrist].at_px.x, 50, 1e-9);
  EXPECT_NEAR(shift.palm.x, 3, 1e-9);
  EXPECT_NEAR(shift.wrist.y, -1, 1e-9);
  points[kLeftHand].at_px = {80, 0};
  take_shift(shift, true, points);
  EXPECT_NEAR(points[kLeftHand].at_px.x, 80 + 0.8 * 3, 1e-9);
}

TEST(BodyPoints, TheLineAcrossTurnsWithTheViewingRay) {
  const SeenBody body = upright({100, 100}, 100);
  const Across ahead = across_of(body, {0, 0, 2});
  EXPECT_NEAR(ahead.shoulders.x, 1, 1e-9);
  EXPECT_NEAR(ahead.shoulders.z, 0, 1e-9);
  const Across beside = across_of(body, {2, 0, 2});  // 45 degrees to the right: who faces the camera there turns with it
  EXPECT_NEAR(beside.hips.x, std::sqrt(0.5), 1e-9);
  EXPECT_NEAR(beside.hips.z, -std::sqrt(0.5), 1e-9);
}

TEST(BodyFit, PointsAndDepthGiveTheBodyBack) {
  const Places places = standing();
  Standing s(places);
  Choices chosen;
  choose(s.scene, chosen);
  Fitted fitted;
  Fit().run(s.scene, chosen, {}, fitted);
  for (const JointId id : kFreeJoints) {
    EXPECT_LT(distance(fitted.places[id], places[id]), 0.015) << name_of(id);
    EXPECT_GT(fitted.covariance[id].sigma_m(), 0.005) << name_of(id);
    EXPECT_LT(fitted.covariance[id].sigma_m(), 0.06) << name_of(id);
  }
}

TEST(BodyFit, WhatLeapsIsNotHeldWhereItWasExpected) {
  // The head is seen 25 cm nearer than expected, eight sigmas, with nothing wrong with what is seen.
  Places places = standing();
  for (const JointId id : kFreeJoints) places[id].z -= 0.25;
  Standing s(places);
  s.scene.expected[kHead].p.z += 0.25;
  Choices chosen;
  choose(s.scene, chosen);
  chosen[kHead] = {places[kHead], true, 0.02};
  Fitted fitted;
  Fit().run(s.scene, chosen, {}, fitted);
  EXPECT_LT(distance(fitted.places[kHead], places[kHead]), 0.03);
}

TEST(BodyFit, BonesHoldAHiddenJoint) {
  const Places places = standing();
  Standing s(places);
  Choices chosen;
  choose(s.scene, chosen);
  chosen[kRightElbow] = {places[kRightElbow] + Vec3{0, 0, 0.1}, false, 0};
  s.scene.expected[kRightElbow] = {places[kRightElbow] + Vec3{0, 0, 0.1}, 0.2, 5};
  Fitted fitted;
  Fit().run(s.scene, chosen, {}, fitted);
  const double upper = distance(fitted.places[kRightShoulder], fitted.places[kRightElbow]);
  EXPECT_NEAR(upper, s.lengths[Bone::kUpperArm], 0.03);
  EXPECT_GT(fitted.covariance[kRightElbow].sigma_m(), fitted.covariance[kLeftElbow].sigma_m());
}

TEST(BodyFit, AForearmTakenForTooLongDoesNotPushAHiddenHandOffTheBack) {
  // Both are hidden, 11 cm behind the plane of shoulders and hips, and guessed 15 cm behind that.
  Places places = standing();
  places[kLeftElbow] = {0.25, -0.19, 2.05};
  places[kLeftWrist] = {0.08, -0.05, 2.11};
  places[kLeftHand] = {0.03, -0.01, 2.11};
  const auto off_m = [&](HandSight sight) {
    Standing s(places);
    Choices chosen;
    choose(s.scene, chosen);
    for (const JointId id : {kLeftWrist, kLeftHand}) {
      const Vec3 guess = places[id] + Vec3{0, 0, 0.15};
      chosen[id] = {guess, false, 0};
      s.scene.expected[id] = {guess, 0.1, 10};
    }
    s.scene.hands[0] = sight;
    Fitted fitted;
    Fit().run(s.scene, chosen, {}, fitted);
    return distance(fitted.places[kLeftWrist], places[kLeftWrist]);
  };
  EXPECT_LT(off_m(HandSight::kAbsent), 0.75 * off_m(HandSight::kSeen));
}

TEST(BodyFit, AnArmThatTheTrunkHidesFromTheSideHangsBesideIt) {
  // Turned by 90 degrees, the left side away; the left arm is hidden, and was guessed 15 cm towards the trunk.
  Places places = standing();
  for (Vec3& p : places.all) p = {2 - p.z, p.y, 2 + p.x};
  const auto off_m = [&](bool from_side) {
    Standing s(places, {0, 0, 1});
    if (!from_side) s.scene.trunk.across = {1, 0, 0};
    Choices chosen;
    choose(s.scene, chosen);
    for (const JointId id : {kLeftWrist, kLeftHand}) {
      const Vec3 guess = places[id] - Vec3{0, 0, 0.15};
      chosen[id] = {guess, false, 0};
      s.scene.expected[id] = {guess, 0.1, 10};
    }
    Fitted fitted;
    Fit().run(s.scene, chosen, {}, fitted);
    return distance(fitted.places[kLeftWrist], places[kLeftWrist]);
  };
  EXPECT_LT(off_m(true), 0.8 * off_m(false));
}

TEST(BodyFit, BonesGetTheirLengthsAndKeepTheirDirections) {
  const Places places = standing();
  const Lengths lengths(0.9);
  const Places out = with_lengths(places, lengths);
  EXPECT_NEAR(distance(out[kLeftShoulder], out[kRightShoulder]), lengths[Bone::kShoulders], 1e-12);
  EXPECT_NEAR(out[kLeftShoulder].x, 0.9 * 0.1725, 1e-12);  // the middle stays at 0
  EXPECT_NEAR(distance(out[kRightElbow], out[kRightWrist]), lengths[Bone::kForearm], 1e-12);
  EXPECT_NEAR(distance(out[kLeftAnkle], out[kLeftFoot]), lengths[Bone::kFoot], 1e-12);
  const Vec3 was = places[kRightWrist] - places[kRightElbow], is = out[kRightWrist] - out[kRightElbow];
  EXPECT_NEAR(norm(cross(normalized(was), normalized(is))), 0, 1e-12);
}

TEST(BodyFit, SpineAndNeckLeaveAtRightAngles) {
  Places places = standing();
  places[kLeftHip].y += 0.05;  // the hips are tilted, and the shoulders the other way
  places[kRightShoulder].y += 0.04;
  complete(places);
  EXPECT_NEAR(dot(places[kSpine] - places[kPelvis], places[kLeftHip] - places[kRightHip]), 0, 1e-12);
  EXPECT_NEAR(dot(places[kNeck] - places[kChest], places[kLeftShoulder] - places[kRightShoulder]), 0, 1e-12);
  EXPECT_LT(distance(places[kSpine], middle(places[kPelvis], places[kChest])), 0.06);
  EXPECT_LT(places[kNeck].y, places[kChest].y - 0.08);
  // However the shoulders are tilted, the neck is as long.
  EXPECT_NEAR(distance(places[kNeck], places[kChest]), std::hypot(0.225 * distance(places[kChest], places[kPelvis]), 0.022),
              1e-12);
}

TEST(BodySurfaceMap, HeightsGoAlongWithTheTrunk) {
  const Places places = standing();
  const TrunkAxes axes = trunk_axes(places);
  EXPECT_NEAR(axes.front.z, -1, 1e-9);
  SurfaceMap map;
  const Vec3 on_plane = axes.shoulders + 0.2 * axes.down;
  const double before = *map.height_m(axes, on_plane, 0.345);
  EXPECT_GT(before, 0.06);
  EXPECT_FALSE(map.height_m(axes, on_plane + Vec3{0.5, 0, 0}, 0.345));
  Map depth;
  depth.fill({0, 0, 320, 240}, 1.95);  // a flat chest
  for (int i = 0; i < 20; ++i) map.learn(depth.view(), axes, places, 1);
  EXPECT_NEAR(*map.height_m(axes, on_plane, 0.345), 0.05, 0.01);
  // Another place: the map goes with the person.
  Places moved = places;
  for (const JointId id : kFreeJoints) moved[id] = moved[id] + Vec3{0.3, 0, 0.5};
  EXPECT_NEAR(*map.height_m(trunk_axes(moved), on_plane + Vec3{0.3, 0, 0.5}, 0.345), 0.05, 0.01);
}

TEST(BodyLimbs, CutsFindTheMiddleAndTheDepthOfAForearm) {
  Places places = standing();
  Standing s(places);
  Map map;
  // The left forearm goes down from 204 px to 210; a band of 16 px, whose middle lies 2 px to the right of it.
  const Vec2 elbow = s.scene.points[kLeftElbow].at_px, wrist = s.scene.points[kLeftWrist].at_px;
  const double behind = (depth_of_joint_m(s.scene, kLeftElbow, 2) + depth_of_joint_m(s.scene, kLeftWrist, 2)) / 2;
  for (int y = 0; y < 240; ++y) {
    const double middle = elbow.x + (y - elbow.y) / (wrist.y - elbow.y) * (wrist.x - elbow.x) + 2;
    map.fill({static_cast<int>(std::lround(middle)) - 8, y, 16, 1}, 2 - behind);
  }
  s.scene.depth = map.view();
  Choices chosen;
  for (const JointId id : {kLeftElbow, kLeftWrist}) chosen[id] = {places[id], true, 0.02};
  LimbSamples samples;
  sample_limbs(s.scene, chosen, samples);
  ASSERT_EQ(samples.count, 4u);
  for (const LimbSample& sample : samples.get()) {
    EXPECT_NEAR(sample.z_m, 2, 0.02);
    ASSERT_TRUE(sample.has_edges);
    const double at_y = elbow.x + sample.share * (wrist.x - elbow.x);
    EXPECT_NEAR(sample.middle_px.x - at_y, 2, 1.1);
  }
}

}  // namespace
}  // namespace duo::body
