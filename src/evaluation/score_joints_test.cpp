// The scorer of clips against numbers worked out by hand.
#include "duoptic/evaluation.h"

#include <gtest/gtest.h>

#include <cmath>

namespace duo {
namespace {

constexpr JointState kSeen = JointState::kSeen, kInferred = JointState::kInferred, kLost = JointState::kLost;

TEST(JointScore, ByHand) {
  const JointScore s = score_joint({
      {true, kSeen, 10, 5},        // inside 3 sigma = 15
      {true, kSeen, 30, 5},        // outside
      {true, kLost, 999, 1},       // bad; its error and sigma count nowhere
      {true, kInferred, 150, 60},  // bad, yet inside 180
      {true, kSeen, 100, 30},      // just good; outside 90
      {false, kInferred, 80, 20},  // hidden; outside
      {false, kLost, 0, 0},
      {false, kInferred, 60, 20},  // inside: 60 <= 60
  });
  EXPECT_EQ(*s.median_mm, 30);         // 10 30 100 150
  EXPECT_EQ(*s.p95_mm, 100);           // index floor(2.85)
  EXPECT_EQ(*s.bad_percent, 40);       // 2 of 5
  EXPECT_EQ(*s.hidden_median_mm, 60);  // of 60 80
  EXPECT_NEAR(*s.hidden_lost_percent, 100.0 / 3, 1e-9);
  EXPECT_EQ(*s.hidden_false_percent, 0);
  EXPECT_EQ(*s.inside_3_sigma_percent, 50);  // 3 of 6
  EXPECT_FALSE(s.frames_to_recover);         // three hidden frames are no hiding
}

TEST(JointScore, HiddenJointsThatAreCalledSeen) {
  const JointScore s = score_joint({
      {false, kSeen, 101, 20},      // false
      {false, kSeen, 100, 20},      // just not
      {false, kInferred, 300, 20},  // says that it is a guess
      {false, kLost, 300, 20},
      {true, kSeen, 300, 20},  // bad, but not hidden
  });
  EXPECT_EQ(*s.hidden_false_percent, 25);
}

TEST(JointScore, OutsideThePictureItMayBeAnywhere) {
  const JointScore s = score_joint({
      {false, kInferred, 70, 20},
      {false, kInferred, 400, 200, false},
      {false, kLost, 0, 0, false},
  });
  EXPECT_EQ(*s.hidden_median_mm, 70);
  EXPECT_EQ(*s.hidden_lost_percent, 0);
}

TEST(JointScore, NothingToSay) {
  const JointScore s = score_joint({});
  EXPECT_FALSE(s.median_mm || s.p95_mm || s.bad_percent || s.frames_to_recover || s.hidden_median_mm || s.hidden_lost_percent ||
               s.inside_3_sigma_percent);
  EXPECT_FALSE(score_joint({{true, kSeen, 1, 1}}).hidden_lost_percent);
}

/// '.' hidden, 'g' visible and good, 'b' visible and bad.
JointScore recovery(const char* frames) {
  std::vector<JointSample> samples;
  for (const char* f = frames; *f != 0; ++f)
    samples.push_back(*f == '.'   ? JointSample{false, kLost, 0, 0}
                      : *f == 'g' ? JointSample{true, kSeen, 50, 20}
                                  : JointSample{true, kSeen, 101, 20});
  return score_joint(samples);
}

TEST(JointScore, FramesToRecover) {
  EXPECT_FALSE(recovery("ggbbg....bbbg").frames_to_recover);  // four hidden are too few
  EXPECT_EQ(recovery("g.....g").frames_to_recover, 0);
  EXPECT_EQ(recovery("g.....bbg").frames_to_recover, 2);
  EXPECT_EQ(recovery("g.....bbg.....bbbbg.....bg").frames_to_recover, 4);  // the most
  EXPECT_EQ(recovery("g.....bb......bg").frames_to_recover, 3);            // hidden again before it was found
  EXPECT_TRUE(recovery("g.....bbg").recovered);
  const JointScore never = recovery("g.....bbb");
  EXPECT_EQ(never.frames_to_recover, 3);
  EXPECT_FALSE(never.recovered);
}

// Rig and left camera coincide: f = 100, b = 0.1 m, centre (1, 0). 5 px is z = 2 m.
TEST(DepthScore, ByHand) {
  const Rectified rectified{{100, 1, 0, 0.1}, {8, 1}, {}, {}};
  Camera left;
  left.fx_px = left.fy_px = 100;
  left.cx_px = 1;
  DepthTruth truth{Image<std::uint16_t>({8, 1}), Image<std::uint8_t>({8, 1})};
  Frame frame;
  frame.disparity.d_q4 = Image<std::uint16_t>({8, 1});
  const std::uint16_t d_q4[8] = {80, 80, 80, 80, 0xFFFF, 80, 88, 128};
  for (int x = 0; x < 8; ++x) {
    truth.z_tenth_mm.at(0, x) = 20000;
    truth.figure.at(0, x) = x >= 3 ? 255 : 0;
    frame.disparity.d_q4.at(0, x) = d_q4[x];
  }
  // On the person: x = 3 .. 7; 3 and 4 lie left of 5 px, outside the right picture. Errors 0, 0.5 and 3 px.
  DepthTally tally;
  EXPECT_FALSE(tally.score());
  tally.add(frame, rectified, left, truth);
  const auto s = tally.score();
  ASSERT_TRUE(s);
  EXPECT_EQ(s->coverage_percent, 100);
  EXPECT_NEAR(s->bad_percent, 100.0 / 3, 1e-9);
  EXPECT_EQ(s->median_px, 0.5);
  EXPECT_NEAR(s->median_depth_percent, 100 * (1 - 5 / 5.5), 1e-9);
  EXPECT_EQ(s->bias_px, 0.5);
  EXPECT_EQ(s->background_bias_px, 0) << "none is seen by both";

  // x = 5 of the background instead, and too far by 1/4 px.
  truth.figure.at(0, 5) = 0;
  frame.disparity.d_q4.at(0, 5) = 76;
  DepthTally apart;
  apart.add(frame, rectified, left, truth);
  EXPECT_EQ(apart.score()->bias_px, 0.5);
  EXPECT_EQ(apart.score()->background_bias_px, -0.25);
  truth.figure.at(0, 5) = 255;
  frame.disparity.d_q4.at(0, 5) = 80;

  frame.disparity.d_q4.at(0, 6) = Disparity::kNone;
  tally.add(frame, rectified, left, truth);
  EXPECT_NEAR(tally.score()->coverage_percent, 500.0 / 6, 1e-9);
}

// The left camera is turned by 0.1: the ray of x = 8 has the angle atan(0.08) + 0.1 = 0.17983 there, hence column
// 100 tan(0.17983) = 18.18, and z of its point is 1.003195 cos(0.17983) = 0.987017 of z in the rig frame. 2 m become 2.02631,
// 4.93508 px.
TEST(DepthScore, TurnsTheRayIntoTheRawCamera) {
  Rectified rectified{{100, 0, 0, 0.1}, {9, 1}, {}, {}};
  const double c = std::cos(0.1), s = std::sin(0.1);
  rectified.rig_from_left = {{c, 0, -s, 0, 1, 0, s, 0, c}};
  Camera left;
  left.fx_px = left.fy_px = 100;
  DepthTruth truth{Image<std::uint16_t>({20, 1}), Image<std::uint8_t>({20, 1})};
  truth.z_tenth_mm.at(0, 18) = 20000;
  truth.figure.at(0, 18) = 255;
  Frame frame;
  frame.disparity.d_q4 = Image<std::uint16_t>({9, 1});
  frame.disparity.d_q4.at(0, 8) = 80;
  DepthTally tally;
  tally.add(frame, rectified, left, truth);
  const auto score = tally.score();
  ASSERT_TRUE(score);
  EXPECT_EQ(score->coverage_percent, 100);
  EXPECT_NEAR(score->median_px, 5 - 4.93508, 1e-5);
}

}  // namespace
}  // namespace duo
