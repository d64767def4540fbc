// Two videos that did not begin together are told by how much moves in them; what cannot be told is not said.
#include "pipeline/offset_watch.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <random>

namespace duo {
namespace {

/// How much moves in picture i.
using Motion = std::function<double(int)>;

std::string told(const Motion& left, const Motion& right, int pairs = 90) {
  OffsetWatch watch;
  for (int i = 0; i < pairs; ++i) watch.see(i * TimeNs{40'000'000}, {left(i), right(i)}, 100);
  return watch.warning();
}

/// Somebody moves, and rests, at no regular times.
double irregular(int i) { return 1000 * std::pow(std::sin(0.05 * i) * std::sin(0.13 * i + 1), 2); }
/// The same in a camera that sees other noise, and it larger.
double in_other(int i) {
  std::mt19937 random(static_cast<unsigned>(i + 100));
  return 2 * irregular(i) + random() % 100;
}

/// By hand: ten pictures of 40 ms are 400 ms; the right video began later where its picture i shows the left one's i + 10.
TEST(OffsetWatch, TellsWhichBeganLater) {
  const std::string later = told(irregular, [](int i) { return in_other(i + 10); });
  EXPECT_NE(later.find("begun 400 ms later than the left one"), std::string::npos) << later;
  EXPECT_NE(later.find("add 400 to --skew-ms"), std::string::npos) << later;
  const std::string earlier = told(irregular, [](int i) { return in_other(i - 10); });
  EXPECT_NE(earlier.find("begun 400 ms earlier than the left one"), std::string::npos) << earlier;
  EXPECT_NE(earlier.find("add -400 to --skew-ms"), std::string::npos) << earlier;
}

TEST(OffsetWatch, WhatIsNotDoubted) {
  const auto still = [](int) { return 0.0; };
  const auto noise = [](int i) { return in_other(i) - 2 * irregular(i); };
  EXPECT_EQ(told(irregular, in_other), "");
  EXPECT_EQ(told(irregular, [](int i) { return in_other(i + 1); }), "");  // in step as cameras without a trigger are
  EXPECT_EQ(told(irregular, still), "");
  EXPECT_EQ(told(still, still), "");
  EXPECT_EQ(told(irregular, noise), "");
  EXPECT_EQ(told(
                irregular, [](int i) { return in_other(i + 10); }, 40),
            "");                                                                    // too short
  const auto steady = [](int i) { return 1000 * std::pow(std::sin(0.3 * i), 2); };  // walks: the same after every step
  for (const int later : {4, 5, 8, 21}) EXPECT_EQ(told(steady, [&](int i) { return steady(i + later); }), "") << later;
  // One step of exposure in each, and now and then a noisy pixel.
  const auto step_at = [](int at) { return [at](int i) { return i == at ? 5000.0 : 0.0; }; };
  EXPECT_EQ(told(step_at(40), step_at(50)), "");
  const auto rarely = [](unsigned seed) {
    return [seed](int i) {
      std::mt19937 random(seed + 7u * static_cast<unsigned>(i));
      return random() % 30 == 0 ? 200.0 : 0.0;
    };
  };
  for (unsigned seed = 0; seed < 50; ++seed) EXPECT_EQ(told(rarely(seed), rarely(1000 + seed)), "") << seed;
  EXPECT_EQ(OffsetWatch().warning(), "");
}

}  // namespace
}  // namespace duo
