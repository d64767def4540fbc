// Times that go back are mended and told.
#include "sources/rising_times.h"

#include <gtest/gtest.h>

#include <vector>

namespace duo {
namespace {

/// Ten ms from picture to picture; times in ms.
std::vector<TimeNs> mended(RisingTimes& times, const std::vector<TimeNs>& said_ms) {
  std::vector<TimeNs> out;
  for (const TimeNs t : said_ms) out.push_back(times.next(t * 1'000'000, 10'000'000) / 1'000'000);
  return out;
}

TEST(RisingTimes, WhatRisesStaysAsItIs) {
  RisingTimes times;
  const std::vector<TimeNs> rising = {-30, 0, 10, 10, 35, 1000};
  EXPECT_EQ(mended(times, rising), rising);
  EXPECT_EQ(times.warning("a.mkv"), "");
}

TEST(RisingTimes, JitterHoldsAndAJoinGoesOn) {
  RisingTimes jitter;
  EXPECT_EQ(mended(jitter, {0, 10, 5, 30, 40}), (std::vector<TimeNs>{0, 10, 10, 30, 40}));
  EXPECT_NE(jitter.warning("a.mkv").find("the times of a.mkv go back at picture 2: "), std::string::npos);
  // By hand: after 20 comes 30, which the file calls 0.
  RisingTimes joined;
  EXPECT_EQ(mended(joined, {0, 10, 20, 0, 10, 20, 5, 0}), (std::vector<TimeNs>{0, 10, 20, 30, 40, 50, 50, 60}));
  EXPECT_NE(joined.warning("a.mkv").find("go back 3 times, first at picture 3: "), std::string::npos);
}

// A picture without a time has 0.
TEST(RisingTimes, AWrongTimeIsWrongForItsPictureAlone) {
  RisingTimes one, three;
  EXPECT_EQ(mended(one, {0, 10, 20, 0, 40, 50}), (std::vector<TimeNs>{0, 10, 20, 30, 40, 50}));
  EXPECT_EQ(mended(three, {0, 10, 20, 0, 0, 0, 60, 70}), (std::vector<TimeNs>{0, 10, 20, 30, 30, 30, 60, 70}));
}

TEST(RisingTimes, AfterAJumpAnyTimeIsRight) {
  RisingTimes times;
  mended(times, {0, 10, 20});
  times.jump();
  EXPECT_EQ(mended(times, {0, 10}), (std::vector<TimeNs>{0, 10}));
  EXPECT_EQ(times.warning("a.mkv"), "");
}

}  // namespace
}  // namespace duo
