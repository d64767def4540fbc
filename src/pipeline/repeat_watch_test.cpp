// A camera that hangs, and a video that has its pictures twice, are told; still scenes and noise are not.
#include "pipeline/repeat_watch.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <random>

namespace duo {
namespace {

constexpr Size kWatchedSize = {160, 120};

/// A bar that moves, and noise of two levels where `noise` is not 0.
Image<Rgb8> bar_at(int step, std::uint32_t noise) {
  std::mt19937 random(noise);
  Image<Rgb8> out(kWatchedSize);
  for (int y = 0; y < out.height(); ++y)
    for (int x = 0; x < out.width(); ++x) {
      const bool bar = (x + 160 - 8 * step % 160) % 160 < 24;
      const auto level = static_cast<std::uint8_t>((bar ? 200 : 60) + (noise > 0 ? random() % 5 : 0));
      out.at(y, x) = {level, level, level};
    }
  return out;
}

using StepOf = std::function<int(int pair)>;

/// Pairs whose bars are at these steps.
RepeatWatch watched(int pairs, const StepOf& left, const StepOf& right, bool noisy = false) {
  RepeatWatch watch;
  for (int i = 0; i < pairs; ++i) {
    Pair pair;
    pair.left.pixels = bar_at(left(i), noisy ? static_cast<std::uint32_t>(2 * i + 1) : 0);
    pair.right.pixels = bar_at(right(i), noisy ? static_cast<std::uint32_t>(2 * i + 2) : 0);
    watch.see(pair);
  }
  return watch;
}
int each(int i) { return i; }
int still(int) { return 0; }

TEST(RepeatWatch, ACameraThatHangs) {
  const RepeatWatch right = watched(30, each, [](int i) { return std::min(i, 15); });
  EXPECT_NE(right.warning(true).find("the right camera's pictures stay the same"), std::string::npos) << right.warning(true);
  EXPECT_NE(right.warning(false).find("14 of the right pictures are the same as the one before, up to 14 in a row"),
            std::string::npos)
      << right.warning(false);
  const RepeatWatch left = watched(30, still, each);
  EXPECT_NE(left.warning(true).find("the left camera's pictures stay the same"), std::string::npos) << left.warning(true);
  const RepeatWatch again = watched(30, each, [](int i) { return i < 10 || i > 24 ? i : 10; });
  EXPECT_EQ(again.warning(true), "");  // it moves again
  EXPECT_NE(again.warning(false), "");
}

/// 15 pictures a second written as 30: where the cameras repeat at different moments, half of the pairs are apart.
TEST(RepeatWatch, PicturesThatAreThereTwice) {
  const auto halved = [](int i) { return i / 2; };
  const RepeatWatch one = watched(40, each, halved);
  EXPECT_NE(one.warning(false).find("20 of the right pictures"), std::string::npos) << one.warning(false);
  EXPECT_EQ(one.warning(true), "");
  const RepeatWatch apart = watched(40, halved, [](int i) { return (i + 1) / 2; });
  EXPECT_NE(apart.warning(false).find("left pictures"), std::string::npos) << apart.warning(false);
  EXPECT_EQ(watched(40, halved, halved).warning(false), "");  // both at once: each pair is of one moment
}

TEST(RepeatWatch, WhatIsNotDoubted) {
  for (const bool live : {false, true}) {
    EXPECT_EQ(watched(40, each, each).warning(live), "");
    EXPECT_EQ(watched(40, still, still).warning(live), "");
    EXPECT_EQ(watched(40, still, still, true).warning(live), "");
    EXPECT_EQ(watched(40, each, still, true).warning(live), "");  // it sees no motion, and its noise goes on
    EXPECT_EQ(RepeatWatch().warning(live), "");
    RepeatWatch covered;
    for (int i = 0; i < 40; ++i) {
      Pair pair;
      pair.left.pixels = bar_at(i, 0);
      pair.right.pixels = Image<Rgb8>(kWatchedSize);  // black
      covered.see(pair);
    }
    EXPECT_EQ(covered.warning(live), "");
  }
  EXPECT_EQ(watched(60, each, [](int i) { return i == 30 ? 29 : i; }).warning(false), "");  // one picture came late
}

}  // namespace
}  // namespace duo
