// Where the network of bodies takes left for right, by hand: when its marks are exchanged, and when they must not be.
#include <gtest/gtest.h>

#include "trackers/body/body.h"
#include "trackers/body/standing.h"

namespace duo::body {
namespace {

using namespace test;  // NOLINT: the made-up person

/// The marks of somebody who stands and shows the face or the back.
SeenBody marks(bool face) {
  using enum BodyPoint;
  constexpr std::pair<BodyPoint, JointId> kMarks[] = {
      {kNose, kHead},
      {BodyPoint::kLeftShoulder, JointId::kLeftShoulder},
      {BodyPoint::kRightShoulder, JointId::kRightShoulder},
      {BodyPoint::kLeftElbow, JointId::kLeftElbow},
      {BodyPoint::kRightElbow, JointId::kRightElbow},
      {BodyPoint::kLeftWrist, JointId::kLeftWrist},
      {BodyPoint::kRightWrist, JointId::kRightWrist},
      {kLeftIndex, kLeftHand},
      {kRightIndex, kRightHand},
      {kLeftPinky, kLeftHand},
      {kRightPinky, kRightHand},
      {BodyPoint::kLeftHip, JointId::kLeftHip},
      {BodyPoint::kRightHip, JointId::kRightHip},
      {BodyPoint::kLeftKnee, JointId::kLeftKnee},
      {BodyPoint::kRightKnee, JointId::kRightKnee},
      {BodyPoint::kLeftAnkle, JointId::kLeftAnkle},
      {BodyPoint::kRightAnkle, JointId::kRightAnkle},
  };
  Places places = standing();
  if (!face)
    for (Vec3& p : places.all) p = {-p.x, p.y, 4 - p.z};
  const Rectified camera = geometry();
  SeenBody out;
  for (const auto& [point, joint] : kMarks) {
    SeenPoint& mark = out.points[static_cast<std::size_t>(point)];
    const Vec2 at = camera.project(places[joint]);
    const Vec3 world = places[joint] - places[kPelvis];
    mark.x_q8 = static_cast<std::int32_t>(256 * at.x), mark.y_q8 = static_cast<std::int32_t>(256 * at.y);
    mark.world_q16 = {static_cast<std::int32_t>(65536 * world.x), static_cast<std::int32_t>(65536 * world.y),
                      static_cast<std::int32_t>(65536 * world.z)};
    mark.visible_q15 = mark.present_q15 = 32768;
  }
  out.next = {160 * 256, 120 * 256, 128 * 256, 0};
  return out;
}

/// How many of `frames` that take left for right are exchanged, after some that do not.
int exchanged(int agreed, int frames, double ticks, bool face = false) {
  const SeenBody right = marks(face), wrong = with_sides_exchanged(right);
  Sides sides;
  for (int i = 0; i < agreed; ++i) EXPECT_FALSE(sides.are_exchanged(right, corners_of(right), ticks));
  int count = 0;
  for (int i = 0; i < frames; ++i) count += sides.are_exchanged(wrong, corners_of(right), ticks) ? 1 : 0;
  return count;
}

TEST(BodySides, AreExchangedForEightTicks) {
  EXPECT_EQ(exchanged(5, 3, 1), 3);
  EXPECT_EQ(exchanged(5, 20, 1), 8);
  EXPECT_EQ(exchanged(5, 40, 0.5), 16);  // 60 frames per second
  EXPECT_EQ(exchanged(5, 20, 2), 4);     // 15
}

TEST(BodySides, AreNotExchangedAfterTooFewFrames) {
  EXPECT_EQ(exchanged(0, 20, 1), 0);
  EXPECT_EQ(exchanged(4, 20, 1), 0);
}

TEST(BodySides, AreNotExchangedWhereFramesAreFarApart) {
  EXPECT_EQ(exchanged(20, 20, 3), 0);  // 10 frames per second
  const SeenBody right = marks(false), wrong = with_sides_exchanged(right);
  Sides sides;
  for (int i = 0; i < 20; ++i) EXPECT_FALSE(sides.are_exchanged(right, corners_of(right), 1));
  EXPECT_FALSE(sides.are_exchanged(wrong, corners_of(right), 3));  // two frames were left out
  EXPECT_FALSE(sides.are_exchanged(wrong, corners_of(right), 1));
}

TEST(BodySides, OfWhoShowsTheFaceAreNotExchanged) { EXPECT_EQ(exchanged(20, 20, 1, true), 0); }

/// Somebody who is followed for six frames.
struct Followed {
  Map map;
  Image<Rgb8> picture = Image<Rgb8>({320, 240});
  FrameView frame;
  SeenBody right = marks(false), wrong = with_sides_exchanged(right);
  std::array<SeenHand, 2> seen = {};
  Body::Hands hands = {{&seen[0], &seen[1]}};
  std::optional<Body> body;
  Followed() {
    map.fill({0, 0, 320, 240}, 4);
    map.fill({100, 0, 120, 240}, 1.9);
    frame = {map.view(), picture, 1.0 / 30, BodyModel::kLite, {}};
    body = Body::start(frame, right);
    EXPECT_TRUE(body);
    for (int i = 0; body && i < 6; ++i) EXPECT_EQ(body->track(frame, right, hands).seen, hands.seen) << i;
  }
};

TEST(BodySides, HandsGoAlong) {
  Followed person;
  ASSERT_TRUE(person.body);
  const auto own = person.body->track(person.frame, person.wrong, person.hands);
  EXPECT_EQ(own.seen[0], person.hands.seen[1]);
  EXPECT_EQ(own.seen[1], person.hands.seen[0]);
  EXPECT_LT(person.body->places()[kLeftShoulder].x, -0.1);
}

TEST(BodySides, ShouldersStayForEightFramesAndThenMoveOver) {
  Followed person;
  ASSERT_TRUE(person.body);
  const auto left_m = [&] { return person.body->places()[kLeftShoulder].x; };
  const double first_m = left_m();
  EXPECT_LT(first_m, -0.1);
  for (int i = 0; i < 8; ++i) {
    person.body->track(person.frame, person.wrong, person.hands);
    EXPECT_NEAR(left_m(), first_m, 0.02) << i;
  }
  for (int i = 0; i < 12; ++i) person.body->track(person.frame, person.wrong, person.hands);
  EXPECT_GT(left_m(), 0.1);  // the network was right
}

TEST(BodySides, WhoComesBackTurnedRoundIsNotExchanged) {
  Followed person;
  ASSERT_TRUE(person.body);
  person.body->miss(person.frame, true);
  for (int i = 0; i < 12; ++i) EXPECT_EQ(person.body->track(person.frame, person.wrong, person.hands).seen, person.hands.seen);
  EXPECT_GT(person.body->places()[kLeftShoulder].x, 0.1);
}

}  // namespace
}  // namespace duo::body
