// The body tracker in the first frames of a person.
#include <gtest/gtest.h>

#include "tests/allocations.h"
#include "trackers/body/body.h"
#include "trackers/body/rendered_person.h"
#include "trackers/body/standing.h"
#include "trackers/body/trial.h"

namespace duo {
namespace {

using test::body_tracker, test::copy_of, test::kFrames, test::RenderedPerson;

/// What no network sees anybody in.
Frame dark_frame() {
  Frame dark = copy_of(*RenderedPerson::get().frames[0]);
  for (int y = 0; y < dark.color.height(); ++y)
    for (int x = 0; x < dark.color.width(); ++x) dark.color.at(y, x) = {};
  return dark;
}

/// How many frames pass before somebody is forgotten who is not seen any more.
int frames_until_forgotten(int seen_in) {
  constexpr int kMost = 100;
  const RenderedPerson& person = RenderedPerson::get();
  const auto tracker = body_tracker(person.rig, person.rectified, 1);
  for (int i = 0; i < seen_in; ++i) EXPECT_EQ(tracker->track(*person.frames[static_cast<std::size_t>(i)]).size(), 1u);
  const Frame dark = dark_frame();
  for (int i = 0; i < kMost; ++i)
    if (tracker->track(dark).empty()) return i;
  return kMost;
}

// Frames in which nobody sees it say nothing for it.
TEST(BodyNewcomers, WhoWasSeenOnceIsForgottenSoon) {
  EXPECT_EQ(frames_until_forgotten(1), 15);
  EXPECT_EQ(frames_until_forgotten(kFrames - 1), 15);
  EXPECT_EQ(frames_until_forgotten(kFrames), 75);
}

int seen_joints(const Person& person) {
  int count = 0;
  for (std::size_t j = 0; j < person.count(); ++j) count += person.joints[j].state == JointState::kSeen;
  return count;
}

TEST(BodyNewcomers, WhoComesLaterIsSeenFromTheThirdFrameOn) {
  const RenderedPerson& person = RenderedPerson::get();
  const auto tracker = body_tracker(person.rig, person.rectified, 1);
  const Frame dark = dark_frame();
  EXPECT_TRUE(tracker->track(dark).empty());
  constexpr int kSearches = 8;  // until every part of the picture was looked at
  int tried = 0;
  auto people = tracker->track(*person.frames[0]);
  for (; people.empty() && tried < kSearches; ++tried) people = tracker->track(*person.frames[0]);
  for (int i = 0; i < 5; ++i) {
    ASSERT_EQ(people.size(), 1u) << i;
    EXPECT_EQ(seen_joints(people[0]) > 8, i >= 2) << i;
    people = tracker->track(*person.frames[static_cast<std::size_t>(i) + 1]);
  }
}

TEST(BodyTrial, TenFramesThatShowEnoughMakeAPerson) {
  body::Trial trial;
  for (int i = 0; i < 10; ++i) {
    EXPECT_EQ(trial.is_believed(), i >= 3);
    EXPECT_FALSE(trial.is_over());
    trial.add(std::nullopt, false, 1);  // nothing was looked at
    trial.add(0.34, i > 6, 1);
    EXPECT_FALSE(trial.is_mistake()) << i;
  }
  EXPECT_TRUE(trial.is_over());
}

// At 60 frames a second two ticks after the first frame are in the fifth one; at 10 in the second.
TEST(BodyTrial, GoesByTime) {
  const auto frames_until = [](double ticks, double share, bool is_flat, auto done) {
    body::Trial trial;
    for (int frames = 1; frames < 100; ++frames) {
      trial.add(share, is_flat, ticks);
      if (done(trial)) return frames;
    }
    return 100;
  };
  const auto is_believed = [](const body::Trial& trial) { return trial.is_believed(); };
  const auto is_over = [](const body::Trial& trial) { return trial.is_over(); };
  const auto is_mistake = [](const body::Trial& trial) { return trial.is_mistake(); };
  struct Want {
    double ticks;
    int believed, over, flat, poor;
  };
  for (const Want& want : {Want{0.5, 5, 19, 7, 3}, Want{1, 3, 10, 4, 2}, Want{2, 2, 6, 3, 2}, Want{3, 2, 4, 2, 2}}) {
    EXPECT_EQ(frames_until(want.ticks, 0.9, false, is_believed), want.believed) << want.ticks;
    EXPECT_EQ(frames_until(want.ticks, 0.9, false, is_over), want.over) << want.ticks;
    EXPECT_EQ(frames_until(want.ticks, 0.9, true, is_mistake), want.flat) << want.ticks;
    EXPECT_EQ(frames_until(want.ticks, 0.1, false, is_mistake), want.poor) << want.ticks;
  }
}

// One poor frame may be a slip of the network.
TEST(BodyTrial, WhoShowsTooLittleTwiceInARowIsNone) {
  body::Trial trial;
  for (const double share : {0.32, 0.9, 0.32, 0.9, 0.32}) {
    trial.add(share, false, 1);
    EXPECT_FALSE(trial.is_mistake()) << share;
  }
  trial.add(std::nullopt, false, 1);
  EXPECT_FALSE(trial.is_mistake());
  trial.add(0.32, false, 1);
  EXPECT_TRUE(trial.is_mistake());
}

TEST(BodyTrial, WhatIsFlatInFourFramesIsNone) {
  body::Trial trial;
  for (int i = 0; i < 4; ++i) {
    EXPECT_FALSE(trial.is_mistake());
    trial.add(0.9, true, 1);
    trial.add(0.9, false, 1);
  }
  EXPECT_TRUE(trial.is_mistake());
}

/// Once started, it turns into a picture on a wall: one plane through the person's depth.
TEST(BodyNewcomers, WhoDoesNotStandOutIsDropped) {
  const RenderedPerson& person = RenderedPerson::get();
  const auto tracker = body_tracker(person.rig, person.rectified, 1);
  ASSERT_EQ(tracker->track(*person.frames[0]).size(), 1u);
  constexpr std::uint16_t kPlane_q4 = 290;
  for (int i = 1; i < 8; ++i) {
    Frame flat = copy_of(*person.frames[static_cast<std::size_t>(i)]);
    for (int y = 0; y < flat.disparity.d_q4.height(); ++y)
      for (int x = 0; x < flat.disparity.d_q4.width(); ++x) flat.disparity.d_q4.at(y, x) = kPlane_q4;
    EXPECT_EQ(tracker->track(flat).size(), i < 4 ? 1u : 0u) << i;
  }
}

/// A trunk around a place of the picture that points along `down`; nothing else of it is marked.
SeenBody trunk_at(Vec2 centre, Vec2 down) {
  SeenBody out;
  const auto put = [&](BodyPoint point, double along, double across) {
    SeenPoint& p = out.points[static_cast<std::size_t>(point)];
    p.x_q8 = static_cast<std::int32_t>(256 * (centre.x + along * down.x + across * down.y));
    p.y_q8 = static_cast<std::int32_t>(256 * (centre.y + along * down.y - across * down.x));
    p.world_q16 = {static_cast<std::int32_t>(65536 * 0.465 * across), static_cast<std::int32_t>(65536 * 0.465 * along), 0};
  };
  using enum BodyPoint;
  put(kLeftShoulder, -0.5, 0.37), put(kRightShoulder, -0.5, -0.37), put(kLeftHip, 0.5, 0.22), put(kRightHip, 0.5, -0.22);
  return out;
}

TEST(BodyIdentity, WhoStandsIsUnlikeWhatLies) {
  body::test::Map map;
  map.fill({0, 0, 320, 240}, 4);
  map.fill({100, 40, 120, 160}, 1.9);
  const Image<Rgb8> picture({320, 240});
  const body::FrameView frame{map.view(), picture, 1.0 / 30, BodyModel::kLite, {}};
  const auto stands = body::Body::start(frame, trunk_at({160, 120}, {0, 93}));
  ASSERT_TRUE(stands);
  EXPECT_LT(stands->unlike(frame, trunk_at({160, 120}, {0, 93})), 0.5);
  EXPECT_LT(stands->unlike(frame, trunk_at({160, 120}, {32, 88})), 1);  // bows by 20 degrees
  EXPECT_GT(stands->unlike(frame, trunk_at({160, 120}, {93, 0})), 2.2);
  body::FrameView late = frame;
  late.frame_s = 11.0 / 30;  // ten ticks more: a turn by 90 degrees counts 1 / (0.3 * (1 + 0.3 * 10)) = 0.83
  EXPECT_NEAR(stands->unlike(late, trunk_at({160, 120}, {93, 0})), 0.83, 0.2);
}

// By hand, one tick after it was seen: 35 mm + 250 mm/s / 30 = 43.3 mm, but 80 mm where its network saw none; 1.15 stretches
// both.
TEST(BodyIdentity, OfAHandThatItsNetworkDidNotSeeSigmaSaysMore) {
  body::test::Map map;
  map.fill({0, 0, 320, 240}, 4);
  map.fill({100, 40, 120, 160}, 1.9);
  const Image<Rgb8> picture({320, 240});
  const body::FrameView frame{map.view(), picture, 1.0 / 30, BodyModel::kLite, {}};
  const SeenBody seen = trunk_at({160, 120}, {0, 93});
  const auto variance_m2 = [&](const SeenHand* left) {
    auto body = body::Body::start(frame, seen);
    EXPECT_TRUE(body);
    body->track(frame, seen, {{left, nullptr}});
    Person person;
    body->publish(frame, person);
    return person.joints[body::index_of(JointId::kLeftWrist)].cov_m2.xx;
  };
  const SeenHand none;  // of score 0
  const double more_m2 = variance_m2(&none) - variance_m2(nullptr);
  EXPECT_NEAR(more_m2, body::square(1.15) * (body::square(0.08) - body::square(0.035 + 0.25 / 30)), 1e-6);
}

TEST(BodyNewcomers, AllocateNothingFromTheSecondFrameOn) {
  const RenderedPerson& person = RenderedPerson::get();
  const auto tracker = body_tracker(person.rig, person.rectified, 1);
  tracker->track(*person.frames[0]);
  const long before = test::allocations;
  for (const auto& frame : person.frames) tracker->track(*frame);
  EXPECT_EQ(test::allocations - before, 0);
}

}  // namespace
}  // namespace duo
