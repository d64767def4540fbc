// What is drawn: shapes by hand, and where they are in the pictures.
#include "duoptic/paint.h"

#include <gtest/gtest.h>

#include <array>
#include <set>
#include <tuple>

#include "paint/hue.h"
#include "tests/moment.h"

namespace duo {
namespace {

using namespace test;  // NOLINT: the persons

/// By hand, of a picture 320 px wide, focal length 500 px: 5 cm at 2 m are 12.5 px.
TEST(ColorDisparity, GrayAndCividisGrowBrighterTowardsTheCameras) {
  Image<std::uint16_t> d_q4({4, 1});
  d_q4.at(0, 0) = 16 * 10, d_q4.at(0, 1) = 16 * 30, d_q4.at(0, 2) = 16 * 50, d_q4.at(0, 3) = Disparity::kNone;
  Image<Rgb8> painted(d_q4.size());
  color_disparity(d_q4, {10, 50}, painted, DepthColors::kGray);
  EXPECT_EQ(painted.at(0, 0), (Rgb8{40, 40, 40}));
  EXPECT_EQ(painted.at(0, 1), (Rgb8{147, 147, 147}));  // 40 + 128 * 215 / 255
  EXPECT_EQ(painted.at(0, 2), (Rgb8{255, 255, 255}));
  EXPECT_EQ(painted.at(0, 3), Rgb8{});
  color_disparity(d_q4, {10, 50}, painted, DepthColors::kCividis);
  EXPECT_GT(painted.at(0, 0).b, painted.at(0, 0).r + 30);  // from dark blue to yellow
  EXPECT_GT(painted.at(0, 2).r, painted.at(0, 2).b + 100);
  EXPECT_LT(painted.at(0, 0).g, painted.at(0, 1).g);
  EXPECT_LT(painted.at(0, 1).g, painted.at(0, 2).g);
  EXPECT_EQ(painted.at(0, 3), Rgb8{});
}

TEST(Strips, HaveTheColoursInOrder) {
  const Image<Rgb8> depth = depth_strip(DepthColors::kGray), hue = hue_strip();
  EXPECT_EQ(depth.at(0, 0), (Rgb8{40, 40, 40}));
  EXPECT_EQ(depth.at(0, 255), (Rgb8{255, 255, 255}));
  EXPECT_EQ(hue.at(0, 0), (Rgb8{255, 0, 0}));
  EXPECT_EQ(hue.at(0, 85), (Rgb8{0, 255, 0}));
  EXPECT_EQ(hue.at(0, 171), (Rgb8{0, 0, 255}));
}

TEST(SideBySide, TopAlignedOnBlack) {
  Frame frame;
  frame.left = Image<std::uint8_t>({2, 1}), frame.right = Image<std::uint8_t>({2, 1});
  frame.left.at(0, 1) = 7, frame.right.at(0, 0) = 9;
  const Image<Rgb8> pair = draw_rectified(frame);
  ASSERT_EQ(pair.size(), (Size{4, 1}));
  EXPECT_EQ(pair.at(0, 1), (Rgb8{7, 7, 7}));
  EXPECT_EQ(pair.at(0, 2), (Rgb8{9, 9, 9}));
  Image<Rgb8> high({1, 2});
  high.at(1, 0) = {1, 2, 3};
  const Image<Rgb8> both = side_by_side(std::array<View<const Rgb8>, 2>{pair, high});
  ASSERT_EQ(both.size(), (Size{5, 2}));
  EXPECT_EQ(both.at(1, 4), (Rgb8{1, 2, 3}));
  EXPECT_EQ(both.at(1, 0), Rgb8{});
}

TEST(RoomyRange, LeavesRoomForAnArm) {
  Image<std::uint16_t> d_q4({4, 1});
  d_q4.at(0, 0) = 16 * 4, d_q4.at(0, 1) = 16 * 40, d_q4.at(0, 2) = 16 * 40, d_q4.at(0, 3) = 16 * 40;
  const DisparityRange range = disparity_range(d_q4), roomy = roomy_range(d_q4, 1.25);
  EXPECT_EQ(roomy.near_px, 1.25 * range.near_px);
  EXPECT_EQ(roomy.far_px, range.near_px / 3);
  d_q4.at(0, 0) = d_q4.at(0, 1) = d_q4.at(0, 2) = d_q4.at(0, 3) = Disparity::kNone;
  EXPECT_TRUE(roomy_range(d_q4, 1.25).empty());
}

TEST(DrawUnmatched, DarkPictureAroundALineAroundWhatWasMatched) {
  Frame frame;
  frame.left = Image<std::uint8_t>({5, 4});
  frame.disparity.d_q4 = Image<std::uint16_t>({5, 4});
  for (int y = 0; y < 4; ++y) std::fill_n(frame.left.row(y), 5, std::uint8_t{90});
  constexpr Rgb8 kDrawn = {1, 2, 3}, kLine = {225, 225, 225}, kDark = {30, 30, 30};
  Image<Rgb8> painted({5, 4});
  for (int y = 0; y < 4; ++y) std::fill_n(painted.row(y), 5, kDrawn);
  draw_unmatched(frame, painted);
  EXPECT_EQ(painted.at(0, 0), kDrawn);  // all was matched
  frame.matched = {1, 0, 3, 3};
  draw_unmatched(frame, painted);
  for (int y = 0; y < 4; ++y)
    for (int x = 0; x < 5; ++x)
      EXPECT_EQ(painted.at(y, x), x == 2 && y == 1 ? kDrawn : frame.matched.contains(y, x) ? kLine : kDark) << x << "," << y;
}

TEST(Shapes, BonesAndMarksByHand) {
  Moment moment({320, 240});
  moment.set(kShoulder, {0, 0, 2}, 0.04, 1, 10, 20, JointState::kSeen);
  moment.set(kElbow, {0, 0, 2}, 0.02, 1, 50, 60, JointState::kInferred);
  moment.set(kHand, {0, 0, 2}, 0.02, 1, 90, 60, JointState::kSeen);
  const Shapes shapes = shapes_of(moment.people, clip_header({320, 240}));
  ASSERT_EQ(shapes.bones.size(), 2u);
  const Shapes::Line& upper = shapes.bones[0];
  EXPECT_EQ(std::tuple(upper.x0_px, upper.y0_px, upper.x1_px, upper.y1_px, upper.broken), std::tuple(10, 20, 50, 60, true));
  ASSERT_EQ(shapes.joints.size(), 3u);
  EXPECT_DOUBLE_EQ(shapes.joints[0].half_px, 12.5);
  EXPECT_NEAR(shapes.joints[0].sigma_px, 10, 1e-12);
  EXPECT_FALSE(shapes.joints[0].broken);
  EXPECT_TRUE(shapes.joints[1].broken);

  moment.people[0].joints[kElbow].state = JointState::kLost;
  const Shapes without = shapes_of(moment.people, clip_header({320, 240}));
  EXPECT_TRUE(without.bones.empty());
  EXPECT_EQ(without.joints.size(), 2u);
}

/// A finger has thin bones and no boxes; the hand's shade is its own.
TEST(Shapes, FingersAreThin) {
  Moment moment({320, 240});
  Person person = person_with(kBodyHands);
  for (const JointId id : {JointId::kLeftWrist, JointId::kLeftIndexMcp, JointId::kLeftIndexPip})
    joint_of(person, id) = joint({0, 0, 2});
  moment.people = {person};
  const Shapes shapes = shapes_of(moment.people, clip_header({320, 240}));
  EXPECT_EQ(shapes.joints.size(), 1u);
  ASSERT_EQ(shapes.bones.size(), 2u);
  EXPECT_TRUE(shapes.bones[0].thin && shapes.bones[1].thin);
  EXPECT_EQ(shade_of(JointId::kRightPinkyTip), shade_of(JointId::kRightHand));
}

TEST(Shapes, LabelsByHand) {
  const Moment moment({320, 240});
  const std::vector<Label> labels = labels_of(moment.people[0]);
  ASSERT_EQ(labels.size(), 3u);
  EXPECT_EQ(labels[2].text, "shoulder lost");
  EXPECT_EQ(labels[1].text + " " + labels[1].sigma, "elbow 2.00 m 25 cm");
  EXPECT_EQ(labels[0].text + " " + labels[0].sigma, "hand 1.50 m 2 cm");  // 1.25 cm, rounded up
  Person body = person_with(kBody, 3);
  body.joints[0].state = JointState::kSeen;
  body.sum_up();
  const std::vector<Label> summary = labels_of(body);
  ASSERT_EQ(summary.size(), 1u);
  EXPECT_EQ(summary[0].text, "person 3: 1 of 21 joints seen");
  EXPECT_EQ(summary[0].state, JointState::kSeen);
  Person hands = person_with(kBodyHands, 3);
  joint_of(hands, JointId::kLeftThumbTip) = joint({0, 0, 2});
  joint_of(hands, JointId::kLeftIndexTip) = joint({0.024, 0, 2});
  const std::vector<Label> with_pinch = labels_of(hands);
  ASSERT_EQ(with_pinch.size(), 2u);
  EXPECT_EQ(with_pinch[0].text, "person 3: 2 of 61 joints seen");
  EXPECT_EQ(with_pinch[1].text + " " + with_pinch[1].sigma, "left pinch 2.4 1.0 cm");
}

TEST(Shapes, EachPartOfTheBodyHasAShadeOfItsOwn) {
  TrackHeader header;
  header.skeletons = {&kRightArm, &kLeftArm, &kBody};
  const std::vector<JointId> joints = shaded_joints(header);
  EXPECT_EQ(joints.size(), 13u);
  std::set<std::tuple<int, int, int>> shades;
  for (const JointId joint : joints) shades.insert({shade_of(joint).r, shade_of(joint).g, shade_of(joint).b});
  EXPECT_EQ(shades.size(), joints.size());
  for (const JointDef& joint : kBody.joints)
    for (const JointId same : joints)
      if (part_of(same) == part_of(joint.id)) {
        EXPECT_EQ(shade_of(joint.id), shade_of(same)) << joint.name;
      }
}

TEST(Shades, AreExplainedByLimbsWhereThereAreManyJoints) {
  TrackHeader header;
  const auto keys = [&] {
    std::string text;
    for (const ShadeKey& key : shade_keys(header)) text += key.name + " " + std::to_string(key.joints.size()) + ", ";
    return text;
  };
  header.skeletons = {&kRightArm, &kLeftArm};
  EXPECT_EQ(keys(), "shoulder 1, elbow 1, hand 1, ");
  header.skeletons = {&kBody};
  EXPECT_EQ(keys(), "trunk 5, arm 4, leg 4, ");
  header.skeletons = {&kBodyHands};
  EXPECT_EQ(keys(), "trunk 5, arm 4, leg 4, ");
}

TEST(Panels, JointsAndBonesWhereTheyAre) {
  constexpr Size kSize = {320, 240};
  Moment moment(kSize);
  const TrackHeader header = clip_header(kSize);
  moment.set(kHand, {0, 0, 2}, 0.01, 1, 80, 120, JointState::kSeen);
  moment.set(kElbow, {0.2, 0, 2}, 0.01, 1, 240, 120, JointState::kSeen);
  const auto draw = [&] { return draw_panels(moment.tracked(3), header, {10, 60}); };
  const Image<Rgb8> seen = draw();
  EXPECT_EQ(seen.size(), panels_size(header));
  EXPECT_EQ(seen.width() % 2 + seen.height() % 2, 0);
  const int top = 14;  // the title of a picture half as wide as the widest
  const auto count = [&](const Image<Rgb8>& picture, auto&& like) {
    int n = 0;
    for (int x = 100; x < 220; ++x) n += like(picture.at(top + 120, x));
    return n;
  };
  const auto red = [](Rgb8 c) { return c.r > 180 && c.g < 90 && c.b < 90; };
  EXPECT_EQ(count(seen, red), 120);                        // the whole bone
  EXPECT_EQ(seen.at(top + 60, 160), (Rgb8{40, 80, 200}));  // the picture itself
  const Rgb8 joint = seen.at(top + 120, 80);
  EXPECT_GT(joint.g, 180);
  EXPECT_LT(joint.r, 100);

  moment.people[0].joints[kElbow].state = JointState::kInferred;
  const int broken = count(draw(), red);
  EXPECT_GT(broken, 40);
  EXPECT_LT(broken, 80);
  moment.people[0].joints[kElbow].state = JointState::kLost;
  EXPECT_EQ(count(draw(), red), 0);
}

TEST(Panels, RegionInTheShadeOfTheNearestJoint) {
  constexpr Size kSize = {320, 240};
  Moment moment(kSize);
  const TrackHeader header = clip_header(kSize);
  // The wall at 2 m: x_m = (x - 160) / 250. Hand at the centre, elbow 0.3 m to its right, shoulder lost.
  moment.set(kHand, {0, 0, 2}, 0.01, 1, 0, 0, JointState::kSeen);
  moment.set(kElbow, {0.3, 0, 2}, 0.01, 1, 0, 0, JointState::kSeen);
  Image<Rgb8> drawn(kSize);
  draw_regions(moment.frame, header.rectified, moment.people, drawn);
  const Rgb8 hand = drawn.at(120, 165), elbow = drawn.at(120, 230), wall = drawn.at(30, 165);
  EXPECT_EQ(drawn.at(120, 190), hand);   // 0.12 m along
  EXPECT_EQ(drawn.at(120, 205), elbow);  // 0.18 m
  EXPECT_EQ(drawn.at(120, 260), wall);   // 0.1 m past the elbow
  EXPECT_GT(hand.g, elbow.g);
  EXPECT_GT(elbow.g, wall.g);
  EXPECT_EQ(wall.r, wall.g);
}

TEST(Panels, HueByHand) {
  EXPECT_EQ(color_of_hue(0), (Rgb8{255, 0, 0}));
  EXPECT_EQ(color_of_hue(85), (Rgb8{0, 255, 0}));
  EXPECT_EQ(color_of_hue(171), (Rgb8{0, 0, 255}));
  Image<Rgb8> src({3, 1}), dst({3, 1});
  src.at(0, 0) = {90, 0, 0};       // saturated, however dark
  src.at(0, 1) = {77, 77, 77};     // gray
  src.at(0, 2) = {200, 150, 150};  // saturation 1/4: half as bright
  draw_hue(src, dst);
  EXPECT_EQ(dst.at(0, 0), (Rgb8{255, 0, 0}));
  EXPECT_EQ(dst.at(0, 1), (Rgb8{0, 0, 0}));
  EXPECT_NEAR(dst.at(0, 2).r, 127, 1);
  EXPECT_EQ(dst.at(0, 2).g, 0);
}

TEST(Panels, WhateverTheSizes) {
  for (const Size raw : {Size{1, 1}, Size{3, 5}, Size{161, 90}, Size{1280, 720}, Size{720, 1280}})
    for (const Size map : {Size{1, 1}, Size{40, 90}, Size{700, 500}}) {
      Moment moment(map);
      TrackHeader header = clip_header(map);
      header.size = raw;
      moment.left.pixels = Image<Rgb8>(raw);
      EXPECT_EQ(draw_panels(moment.tracked(0), header, {}).size(), panels_size(header));
      EXPECT_EQ(panels_size(header).width % 2, 0);
      EXPECT_EQ(panels_size(header).height % 2, 0);
    }
}

}  // namespace
}  // namespace duo
