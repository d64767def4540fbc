#include "pipeline/focus_line.h"

#include <gtest/gtest.h>

#include <array>
#include <thread>

#include "duoptic/skeleton.h"

namespace duo {
namespace {

/// f = 500 px, 10 cm: 50 px of disparity at 1 m.
Rectified plain_rig() {
  Rectified out;
  static_cast<Pinhole&>(out) = {500, 320, 240, 0.1};
  out.size = {640, 480};
  return out;
}

Person with_head_at(Vec3 p_m, Vec3 v_m_s = {}) {
  Person person;
  person.skeleton = &kBody;
  person.joints[0] = {.p_in_rig_m = p_m, .v_in_rig_m_s = v_m_s, .state = JointState::kSeen};
  return person;
}

TEST(FocusLine, TheBoxAroundAJoint) {
  // 25 cm around what is 2 m away: 500 * 0.25 / 1.75 = 71.43 px to each side.
  const Person person = with_head_at({0, 0, 2});
  const Focus focus = around({&person, 1}, plain_rig(), 0.1);
  EXPECT_EQ(focus.window, (Window{248, 168, 392 - 248, 312 - 168}));
  EXPECT_EQ(focus.disparity_begin, 0);
  EXPECT_EQ(focus.disparity_end, Engine::kMaxDisparity);
}

TEST(FocusLine, WhoIsLargeInThePictureIsMatchedInEverySecondRow) {
  const Person near = with_head_at({0, 0, 1}), far = with_head_at({0, 0, 1.01});  // 500 and 495 rows a metre
  EXPECT_EQ(around({&near, 1}, plain_rig(), 0.1).row_step, 2);
  EXPECT_EQ(around({&far, 1}, plain_rig(), 0.1).row_step, 1);
  EXPECT_EQ(around(std::array{near, far}, plain_rig(), 0.1).row_step, 1);
}

TEST(FocusLine, GoesWhereTheJointWillBe) {
  const Person person = with_head_at({0, 0, 2}, {2, 0, 0});  // in 0.1 s 50 px to the right
  const Focus focus = around({&person, 1}, plain_rig(), 0.1);
  EXPECT_EQ(focus.window, (Window{248, 168, 442 - 248, 312 - 168}));
}

TEST(FocusLine, NobodyIsAllOfThePicture) {
  EXPECT_TRUE(around({}, plain_rig(), 0.1).window.empty());
  const Person beside = with_head_at({10, 0, 2});
  EXPECT_TRUE(around({&beside, 1}, plain_rig(), 0.1).window.empty());
  Person lost = with_head_at({0, 0, 2});
  lost.joints[0].state = JointState::kLost;
  EXPECT_TRUE(around({&lost, 1}, plain_rig(), 0.1).window.empty());
}

TEST(FocusLine, OfFilesThePairsWaitForTheFrameTheyDependOn) {
  FocusLine line(plain_rig(), 1.0 / 30, false);
  const Person near = with_head_at({0, 0, 1}), far = with_head_at({0, 0, 2});
  for (int n = 0; n < FocusLine::kBehind; ++n) EXPECT_TRUE(line.next().window.empty());
  line.tell({&far, 1}, 0);
  EXPECT_TRUE(line.next().window.empty());  // number 4
  std::thread teller([&] {
    line.tell({&near, 1}, 0);
    line.tell({&far, 1}, 0);
  });
  EXPECT_EQ(line.next(), around({&near, 1}, plain_rig(), FocusLine::kBehind / 30.0));
  EXPECT_EQ(line.next(), around({&far, 1}, plain_rig(), FocusLine::kBehind / 30.0));
  teller.join();
  for (int n = 7; n < FocusLine::kFirstWhole + FocusLine::kWholeEvery; ++n) {
    line.tell({&far, 1}, 0);
    EXPECT_FALSE(line.next().window.empty());
  }
  line.tell({&far, 1}, 0);
  EXPECT_TRUE(line.next().window.empty());  // number 20
  line.close();
  EXPECT_TRUE(line.next().window.empty());  // would wait
}

TEST(FocusLine, WhoIsMissedIsLookedForEverywhereInEveryFourthPair) {
  const Person seen = with_head_at({0, 0, 2});
  Person hidden = with_head_at({0.5, 0, 2});
  hidden.joints[0].state = JointState::kInferred;
  FocusLine line(plain_rig(), 1.0 / 30, false);
  for (int n = 0; n < FocusLine::kBehind; ++n) line.next();
  for (int n = FocusLine::kBehind; n < FocusLine::kFirstWhole + FocusLine::kWholeEvery; ++n) {
    line.tell(std::array{seen, hidden}, 0);
    EXPECT_EQ(line.next().window.empty(), n % FocusLine::kMissedEvery == 0) << n;
  }
}

TEST(FocusLine, LiveTheNewestFrameCountsAndNobodyWaits) {
  FocusLine line(plain_rig(), 1.0 / 30, true);
  EXPECT_TRUE(line.next().window.empty());
  EXPECT_TRUE(line.next().window.empty());
  const Person person = with_head_at({0, 0, 2});
  line.tell({}, 0);
  line.tell({&person, 1}, 0);
  EXPECT_EQ(line.next(), around({&person, 1}, plain_rig(), FocusLine::kBehind / 30.0));
  EXPECT_EQ(line.next(), around({&person, 1}, plain_rig(), FocusLine::kBehind / 30.0));
}

TEST(FocusLine, WhereFramesAreLeftOutPeopleGetFarther) {
  FocusLine line(plain_rig(), 1.0 / 30, true);
  const Person person = with_head_at({0, 0, 2}, {0.5, 0, 0});
  line.tell({&person, 1}, 0);
  line.tell({&person, 1}, 250'000'000);
  EXPECT_EQ(line.next(), around({&person, 1}, plain_rig(), 0.5));
  line.tell({&person, 1}, 280'000'000);
  EXPECT_EQ(line.next(), around({&person, 1}, plain_rig(), FocusLine::kBehind / 30.0));
}

TEST(FocusLine, ForgetsPeople) {
  const Person person = with_head_at({0, 0, 2});
  FocusLine live(plain_rig(), 1.0 / 30, true);
  live.tell({&person, 1}, 0);
  live.forget();
  for (int n = 0; n < 2; ++n) EXPECT_TRUE(live.next().window.empty()) << n;
  live.tell({&person, 1}, 0);
  EXPECT_FALSE(live.next().window.empty());
  // Of files pair 7 was free to go once frame 3 was told: pair 8 is the first that can know.
  FocusLine files(plain_rig(), 1.0 / 30, false);
  for (int n = 0; n < 4; ++n) files.tell({&person, 1}, 0);
  files.forget();
  for (int n = 4; n < 7; ++n) files.tell({&person, 1}, 0);
  for (int n = 0; n < 10; ++n) {
    const bool whole = n < FocusLine::kBehind || n == FocusLine::kFirstWhole || n == 8;
    EXPECT_EQ(files.next().window.empty(), whole) << n;
  }
}

}  // namespace
}  // namespace duo
