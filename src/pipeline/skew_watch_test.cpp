// The cost of skew by numbers worked out by hand, and when it is worth a word.
#include "duoptic/skew_watch.h"

#include <gtest/gtest.h>

namespace duo {
namespace {

TEST(Skew, DepthErrorByHand) {
  EXPECT_DOUBLE_EQ(skew_depth_error_m(2, 1, 0.001, 0.125), 0.016);  // 2 m away, 1 m/s, 1 ms, baseline 125 mm: 16 mm
  EXPECT_DOUBLE_EQ(skew_depth_error_m(1, -0.5, 0.016, 0.1), -0.08);
  EXPECT_DOUBLE_EQ(skew_depth_error_m(3, 1, 0, 0.1), 0);
}

/// Tells a watch of a hand at 2 m that was at x_m.
std::optional<std::string> told(SkewWatch& watch, double t_s, double x_m, double skew_ms,
                                JointState state = JointState::kSeen) {
  const auto frame = std::make_shared<Frame>();
  frame->skew_ns = static_cast<TimeNs>(skew_ms * 1e6);
  Person person;
  person.id = 1;
  person.skeleton = &kRightArm;
  person.joints[*kRightArm.index_of(JointId::kRightHand)] = {
      .p_in_rig_m = {x_m, 0, 2}, .cov_m2 = Covariance3::isotropic(0.02), .state = state};
  return watch.see({0, t_s, std::make_shared<Picture>(), frame, {&person, 1}, {}});
}

TEST(Skew, AWarningWhereItMattersAndNotTooOften) {
  SkewWatch watch(0.125);
  EXPECT_FALSE(told(watch, 0, 0, 12));       // no speed yet
  EXPECT_FALSE(told(watch, 0.1, 0.01, 12));  // 0.07 m/s, two thirds of the step's 0.1, x 12 ms: 13 mm
  const auto warning = told(watch, 0.2, 0.11, 12);
  ASSERT_TRUE(warning);  // 0.07 + 2/3 (1 - 0.07) m/s: 132 mm, of which a quarter is left
  EXPECT_NE(warning->find("12.0 ms after"), std::string::npos) << *warning;
  EXPECT_NE(warning->find("hand moves sideways at 0.7 m/s"), std::string::npos) << *warning;
  EXPECT_NE(warning->find("33 mm"), std::string::npos) << *warning;
  EXPECT_FALSE(told(watch, 0.3, 0.21, 12));  // said already
  EXPECT_FALSE(told(watch, 10.3, 1.21, 1));  // 0.1 m/s
  EXPECT_TRUE(told(watch, 10.4, 1.31, -12));
}

TEST(Skew, OnlyWhatIsSeenAndApartInTimeCounts) {
  SkewWatch watch(0.125);
  EXPECT_FALSE(told(watch, 0, 0, 10));
  EXPECT_FALSE(told(watch, 0.1, 0.5, 10, JointState::kInferred));
  EXPECT_FALSE(told(watch, 0.2, 0.5, 10));
  EXPECT_FALSE(told(watch, 0.3, 0.7, 0));
}

}  // namespace
}  // namespace duo
