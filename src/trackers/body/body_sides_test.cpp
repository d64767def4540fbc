// Where the network of bodies takes left for right, by hand: when its marks are exchanged, and when they must not be.
#include <gtest/gtest.h>

#include <utility>

#include "trackers/body/body.h"
#include "trackers/body/standing.h"

namespace duo::body {
namespace {

using namespace test;  // NOLINT: the made-up person

/// The marks of somebody who stands and shows the face or the back.
SeenBody marks(bool face) {
  Places places = standing();
  if (!face)
    for (Vec3& p : places.all) p = {-p.x, p.y, 4 - p.z};
  return marks_of(places);
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

/// How many of `frames` that take one leg for the other are put right, after some that do not, or that mark knees and ankles
/// outwards by `off_m` of where legs are expected that have not been seen for `hidden` ticks.
int legs_put_right(int agreed, int frames, double apart_m, double ticks = 1, double off_m = 0, double hidden = 0) {
  Places places = standing();
  for (const Limb& leg : kLegChains)
    for (const std::size_t n : {1, 2, 3}) places[leg[n]].x = (is_left(leg[n]) ? 0.5 : -0.5) * apart_m;
  const Standing right(places);
  LegSides sides;
  int count = 0;
  for (int i = 0; i < agreed + frames; ++i) {
    Scene scene = right.scene;
    if (i >= agreed)
      for (const std::size_t n : {1, 2, 3}) std::swap(scene.points[kLegChains[0][n]], scene.points[kLegChains[1][n]]);
    else
      for (const Limb& leg : kLegChains)
        for (const std::size_t n : {1, 2}) {
          scene.points[leg[n]].at_px.x += (is_left(leg[n]) ? 200 : -200) * off_m;
          scene.expected[leg[n]].hidden = hidden;
        }
    const double before = scene.points[kLeftKnee].at_px.x;
    sides.put_right(scene, ticks);
    const bool swapped = scene.points[kLeftKnee].at_px.x != before;
    EXPECT_TRUE(i >= agreed || !swapped);
    if (swapped) {
      for (const JointId id : {kLeftKnee, kRightAnkle, kLeftFoot}) {
        EXPECT_EQ(scene.points[id].at_px.x, right.scene.points[id].at_px.x);
      }
    }
    count += swapped ? 1 : 0;
  }
  return count;
}

TEST(BodySides, LegsArePutRightForFourTicksAfterFramesThatAgree) {
  EXPECT_EQ(legs_put_right(3, 2, 0.4), 2);
  EXPECT_EQ(legs_put_right(3, 20, 0.4), 4);
  EXPECT_EQ(legs_put_right(2, 20, 0.4), 0);
  EXPECT_EQ(legs_put_right(3, 20, 0.4, 0.5), 8);  // 60 frames per second
  EXPECT_EQ(legs_put_right(3, 20, 0.4, 3), 0);    // 10: legs pass each other in a step
  EXPECT_EQ(legs_put_right(3, 20, 0.06), 0);      // they pass each other now
}

TEST(BodySides, HiddenLegsAgreeWhereTheyAreAsNearAsThoseThatShow) {
  // All four together 20 and 32 cm off; 25 are near enough.
  for (const double hidden : {0.0, 8.0}) {
    EXPECT_EQ(legs_put_right(3, 2, 0.4, 1, 0.05, hidden), 2) << hidden;
    EXPECT_EQ(legs_put_right(3, 2, 0.4, 1, 0.08, hidden), 0) << hidden;
  }
}

/// A hand in the picture whose network is sure of it, at the marks of the left or right wrist and knuckles.
SeenHand hand_at(const SeenBody& marks, bool left) {
  SeenHand out;
  out.score_q15 = 32767;
  out.points.fill(marks.at(left ? BodyPoint::kLeftIndex : BodyPoint::kRightIndex));
  out.points[0] = marks.at(left ? BodyPoint::kLeftWrist : BodyPoint::kRightWrist);
  return out;
}

/// Somebody who is followed for six frames, both hands seen by their network.
struct Followed {
  Map map;
  Image<Rgb8> picture = Image<Rgb8>({320, 240});
  FrameView frame;
  SeenBody right = marks(false), wrong = with_sides_exchanged(right);
  std::array<SeenHand, 2> seen = {hand_at(right, true), hand_at(right, false)};
  Body::Hands hands = {{&seen[0], &seen[1]}};        // as they are looked at where the marks are right,
  Body::Hands wrong_hands = {{&seen[1], &seen[0]}};  // and where they are wrong
  std::optional<Body> body;
  Followed() {
    map.fill({0, 0, 320, 240}, 4);
    map.fill({100, 0, 120, 240}, 1.9);
    frame = {map.view(), picture, 1.0 / 30, BodyModel::kLite, {}};
    body = Body::start(frame, right);
    EXPECT_TRUE(body);
    for (int i = 0; body && i < 6; ++i) body->track(frame, right, hands);
  }
};

TEST(BodySides, HandsGoAlong) {
  Followed person;
  ASSERT_TRUE(person.body);
  const auto expect_own = [&person] {
    EXPECT_EQ(person.body->shown_hand(true), &person.seen[0]);
    EXPECT_EQ(person.body->shown_hand(false), &person.seen[1]);
  };
  expect_own();
  person.body->track(person.frame, person.wrong, person.wrong_hands);
  expect_own();
  EXPECT_LT(person.body->places()[kLeftShoulder].x, -0.1);
  person.body->miss(person.frame, false);
  EXPECT_EQ(person.body->shown_hand(true), nullptr);
}

TEST(BodySides, ShouldersStayForEightFramesAndThenMoveOver) {
  Followed person;
  ASSERT_TRUE(person.body);
  const auto left_m = [&] { return person.body->places()[kLeftShoulder].x; };
  const double first_m = left_m();
  EXPECT_LT(first_m, -0.1);
  for (int i = 0; i < 8; ++i) {
    person.body->track(person.frame, person.wrong, person.wrong_hands);
    EXPECT_NEAR(left_m(), first_m, 0.02) << i;
  }
  for (int i = 0; i < 12; ++i) person.body->track(person.frame, person.wrong, person.wrong_hands);
  EXPECT_GT(left_m(), 0.1);  // the network was right
}

TEST(BodySides, WhoComesBackTurnedRoundIsNotExchanged) {
  Followed person;
  ASSERT_TRUE(person.body);
  person.body->miss(person.frame, true);
  for (int i = 0; i < 12; ++i) person.body->track(person.frame, person.wrong, person.wrong_hands);
  EXPECT_EQ(person.body->shown_hand(true), &person.seen[1]);
  EXPECT_GT(person.body->places()[kLeftShoulder].x, 0.1);
}

}  // namespace
}  // namespace duo::body
