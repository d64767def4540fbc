// Fingers in space by hand: a hand that is held flat before the camera, 1 m away.
#include "trackers/body/fingers.h"

#include <gtest/gtest.h>

#include "trackers/body/standing.h"

namespace duo::body {
namespace {

/// A map with its picture.
struct Pictured : test::Map {
  Image<Rgb8> picture = Image<Rgb8>({320, 240});
  FrameView view() const { return {test::Map::view(), picture, 1.0 / 30, BodyModel::kLite, {}}; }
};

constexpr double kAlong_m[kHandPoints] = {0,     0.02, 0.05, 0.08, 0.10, 0.09, 0.13, 0.15, 0.17, 0.09, 0.14,
                                          0.165, 0.19, 0.09, 0.13, 0.15, 0.17, 0.08, 0.11, 0.13, 0.15};
constexpr double kAside_m[kHandPoints] = {0,     0.02,  0.04,   0.05,   0.06,   0.025,  0.028, 0.03,   0.03,   0.005, 0.005,
                                          0.005, 0.005, -0.012, -0.015, -0.016, -0.017, -0.03, -0.035, -0.037, -0.04};

/// A left hand in the middle of the picture, fingers up, the thumb on the right; seen as large as it is.
SeenHand flat_hand(const Rectified& geometry, double z_m) {
  SeenHand out;
  out.score_q15 = 32767;
  for (std::size_t i = 0; i < kHandPoints; ++i) {
    const Vec2 at = geometry.project({kAside_m[i], 0.08 - kAlong_m[i], z_m});
    SeenPoint& point = out.points[i];
    point.x_q8 = static_cast<std::int32_t>(std::lround(256 * at.x));
    point.y_q8 = static_cast<std::int32_t>(std::lround(256 * at.y));
    point.world_q16 = {static_cast<std::int32_t>(std::lround(65536 * kAside_m[i])),
                       static_cast<std::int32_t>(std::lround(65536 * (0.08 - kAlong_m[i]))), 0};
  }
  return out;
}

/// A bent finger: its tip so far behind the palm (before it: less than 0) by the network.
void bend(SeenHand& hand, std::size_t tip, double behind_m) {
  hand.points[tip].world_q16[2] = static_cast<std::int32_t>(std::lround(65536 * behind_m));
}

constexpr std::size_t kThumbTip = 4, kIndexTip = 8;  // of the hand; the fingers' own numbers lack the wrist
constexpr double kRound_m = 0.0025;                  // of 1/16 px, and of disparities on limbs

/// By hand: the skin is 1 m away, the middle of the index finger's tip 7 mm behind it.
TEST(Fingers, LieBehindTheirSkin) {
  Pictured map;
  map.fill({100, 60, 120, 120}, 1);
  const auto found = place_fingers(map.view(), flat_hand(map.geometry_, 1), 1.02);
  ASSERT_TRUE(found);
  for (std::size_t i = 0; i < kFingerJoints; ++i) EXPECT_TRUE(found->seen[i]) << i;
  const Vec3 tip = found->p[kIndexTip - 1];
  EXPECT_NEAR(tip.z, 1.007 - DepthView::kThin_px / 40, kRound_m);
  EXPECT_NEAR(tip.x, 0.03, 0.002);
  EXPECT_NEAR(tip.y, -0.09, 0.002);
  // Along the view less is known than across it.
  EXPECT_GT(found->covariance[kIndexTip - 1].zz, found->covariance[kIndexTip - 1].xx);
}

/// Where a finger has no depth of its own, the hand's shape says how deep it is, and that is no sight.
TEST(Fingers, WithoutDepthFollowTheShape) {
  Pictured map;
  map.fill({100, 60, 120, 120}, 1);
  SeenHand hand = flat_hand(map.geometry_, 1);
  bend(hand, kIndexTip, -0.06);
  const double x = hand.points[kIndexTip].x_px(), y = hand.points[kIndexTip].y_px();
  map.fill({static_cast<int>(x) - 8, static_cast<int>(y) - 8, 16, 16}, 0);
  const auto found = place_fingers(map.view(), hand, 1.02);
  ASSERT_TRUE(found);
  EXPECT_FALSE(found->seen[kIndexTip - 1]);
  EXPECT_NEAR(found->p[kIndexTip - 1].z, 0.95, 0.01);
  EXPECT_TRUE(found->seen[kThumbTip - 1]);
  EXPECT_GT(found->covariance[kIndexTip - 1].zz, 2 * found->covariance[kThumbTip - 1].zz);
}

/// What the picture's edge was repeated in is no sight, nor is what lies beyond the picture.
TEST(Fingers, AreNotSeenWhereTheCameraSeesNothing) {
  Pictured map;
  map.fill({100, 60, 120, 120}, 1);
  const SeenHand hand = flat_hand(map.geometry_, 1);
  Image<std::uint8_t> margin({320, 240});
  for (int y = 0; y < 240; ++y)
    for (int x = 0; x < 320; ++x) margin.at(y, x) = y <= hand.points[kIndexTip].y_px() + 4 ? 1 : 0;
  FrameView frame = map.view();
  frame.margin = margin;
  const auto found = place_fingers(frame, hand, 1.02);
  ASSERT_TRUE(found);
  EXPECT_FALSE(found->seen[kIndexTip - 1]);
  EXPECT_TRUE(found->seen[kThumbTip - 1]);
  frame = map.view();
  frame.picture = frame.picture.crop(0, 0, {static_cast<int>(hand.points[kThumbTip].x_px()) - 2, 240});
  const auto beside = place_fingers(frame, hand, 1.02);
  ASSERT_TRUE(beside);
  EXPECT_FALSE(beside->seen[kThumbTip - 1]);
}

/// What stands 15 cm before a finger is not the finger.
TEST(Fingers, AreNotWhatStandsBeforeThem) {
  Pictured map;
  map.fill({100, 60, 120, 120}, 1);
  const SeenHand hand = flat_hand(map.geometry_, 1);
  const double x = hand.points[kIndexTip].x_px(), y = hand.points[kIndexTip].y_px();
  map.fill({static_cast<int>(x) - 8, static_cast<int>(y) - 8, 16, 16}, 0.85);
  const auto found = place_fingers(map.view(), hand, 1.02);
  ASSERT_TRUE(found);
  EXPECT_FALSE(found->seen[kIndexTip - 1]);
  EXPECT_NEAR(found->p[kIndexTip - 1].z, 1.007, 0.01);
}

TEST(Fingers, NeedSomeDepth) {
  Pictured map;
  const SeenHand hand = flat_hand(map.geometry_, 1);
  EXPECT_FALSE(place_fingers(map.view(), hand, 1.02));
  map.fill({100, 60, 120, 120}, 1.5);
  EXPECT_FALSE(place_fingers(map.view(), hand, 1.02)) << "that is a wall";
}

/// A left hand at 1 m before the cameras, whose fingers are followed.
struct FollowedHand {
  Pictured map;
  SeenHand hand;
  Places body = test::standing();
  Fingers fingers{true};
  Person person;
  FollowedHand() {
    map.fill({100, 60, 120, 120}, 1);
    hand = flat_hand(map.geometry_, 1);
    body[JointId::kLeftWrist] = {0, 0.08, 1.02};
    body[JointId::kLeftHand] = {0, 0.01, 1.02};
    person.skeleton = &kBodyHands;
    for (Joint& joint : person.joints) joint.state = JointState::kSeen;
  }
};

/// A hand that is not seen goes along with its wrist for five frames of 1/30 s; its fingers' doubt grows, and then they are
/// lost.
TEST(Fingers, GoAlongWithTheWrist) {
  FollowedHand followed;
  auto& [map, hand, body, fingers, person] = followed;
  const auto tip = [&followed]() -> const Joint& { return *followed.person.find(JointId::kLeftIndexTip); };
  fingers.publish(person);
  EXPECT_EQ(tip().state, JointState::kLost) << "none were seen yet";
  fingers.track(map.view(), &hand, body);
  fingers.publish(person);
  EXPECT_EQ(tip().state, JointState::kSeen);
  const Joint before = tip();
  for (int i = 1; i <= 5; ++i) {
    body[JointId::kLeftWrist].x += 0.01;
    fingers.track(map.view(), nullptr, body);
    fingers.publish(person);
    EXPECT_EQ(tip().state, JointState::kInferred) << i;
    EXPECT_NEAR(tip().p_in_rig_m.x, before.p_in_rig_m.x + 0.01 * i, 1e-9);
    EXPECT_NEAR(tip().cov_m2.yy, before.cov_m2.yy + square(0.015 * i), 1e-12);
  }
  fingers.track(map.view(), nullptr, body);
  fingers.publish(person);
  EXPECT_EQ(tip().state, JointState::kLost);
  EXPECT_EQ(person.find(JointId::kRightIndexTip)->state, JointState::kSeen) << "the other hand's";
}

/// At 60 frames per second four frames are two ticks, and ten are the last that show it.
TEST(Fingers, GoAstrayWithTime) {
  FollowedHand followed;
  auto& [map, hand, body, fingers, person] = followed;
  FrameView frame = map.view();
  frame.frame_s = 1.0 / 60;
  fingers.track(frame, &hand, body);
  fingers.publish(person);
  const Joint& tip = *person.find(JointId::kLeftIndexTip);
  const double before_m2 = tip.cov_m2.yy;
  for (int i = 1; i <= 11; ++i) {
    fingers.track(frame, nullptr, body);
    fingers.publish(person);
    if (i == 4) {
      EXPECT_NEAR(tip.cov_m2.yy, before_m2 + square(0.030), 1e-12);
    }
    EXPECT_EQ(tip.state, i <= 10 ? JointState::kInferred : JointState::kLost) << i;
  }
}

}  // namespace
}  // namespace duo::body
