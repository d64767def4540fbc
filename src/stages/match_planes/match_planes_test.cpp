#include "stages/match_planes/match_planes.h"

#include "tests/agree.h"

namespace duo {
namespace {

// By hand, at (1, 1) of a ramp along x of 10 a column: Sobel x is 4 * 20 / 4 = 20 inside, Sobel y 0; the half-way values are 5
// beside the value. Census: exactly the neighbours to the left are darker.
TEST(MatchPlanes, HandWorked) {
  Image<std::uint8_t> gray({5, 3});
  for (int y = 0; y < 3; ++y)
    for (int x = 0; x < 5; ++x) gray.at(y, x) = static_cast<std::uint8_t>(10 * x);
  PlaneImages out(gray.size(), 0);
  ref::match_planes(gray, {}, 0, false, out);
  EXPECT_EQ(out.value[0].at(1, 2), 20);
  EXPECT_EQ(out.value[1].at(1, 2), 128 + 20);
  EXPECT_EQ(out.value[1].at(1, 0), 128 + 10);  // the edge continues: half the slope
  EXPECT_EQ(out.value[2].at(1, 2), 128);
  EXPECT_EQ(out.low[0].at(1, 2), 15);
  EXPECT_EQ(out.high[0].at(1, 2), 25);
  for (int k = 0; k < 16; ++k)
    EXPECT_EQ(out.census[static_cast<std::size_t>(k / 8)].at(1, 2) >> (k % 8) & 1, kCensus[k][0] < 0 ? 1 : 0) << k;
}

// By hand: on the same ramp, one column darker is 10 darker: no longer beyond a dead zone of 10, but of 9.
TEST(MatchPlanes, DeadZone) {
  Image<std::uint8_t> gray({9, 5});
  for (int y = 0; y < 5; ++y)
    for (int x = 0; x < 9; ++x) gray.at(y, x) = static_cast<std::uint8_t>(10 * x);
  for (const int dead_zone : {9, 10}) {
    PlaneImages out(gray.size(), 0);
    ref::match_planes(gray, {}, dead_zone, false, out);
    for (int k = 0; k < 16; ++k)
      EXPECT_EQ(out.census[static_cast<std::size_t>(k / 8)].at(2, 4) >> (k % 8) & 1, kCensus[k][0] < (dead_zone == 9 ? 0 : -1))
          << k;
  }
}

// By hand, the same ramp as a clear picture: the whole Sobel sum is 4 * 20 = 80; at 20 a column it would be 160, and is cut.
// The interval of gray, 15 .. 25, is three wider at both ends; those of gradients are not. At 0 nothing is below 0.
TEST(MatchPlanes, OfClearPictures) {
  for (const int slope : {10, 20}) {
    Image<std::uint8_t> gray({5, 3});
    for (int y = 0; y < 3; ++y)
      for (int x = 0; x < 5; ++x) gray.at(y, x) = static_cast<std::uint8_t>(slope * x);
    PlaneImages out(gray.size(), 0);
    ref::match_planes(gray, {}, 0, true, out);
    EXPECT_EQ(out.value[1].at(1, 2), 128 + (slope == 10 ? 80 : 127));
    EXPECT_EQ(out.value[2].at(1, 2), 128);
    EXPECT_EQ(out.low[0].at(1, 2), slope == 10 ? 15 - 3 : 30 - 3);
    EXPECT_EQ(out.high[0].at(1, 2), slope == 10 ? 25 + 3 : 50 + 3);
    EXPECT_EQ(out.low[0].at(1, 0), 0);
    EXPECT_EQ(out.low[1].at(1, 2), out.value[1].at(1, 2)) << "a ramp has one gradient";
    EXPECT_EQ(out.low[2].at(1, 2), 128);
    EXPECT_EQ(out.high[2].at(1, 2), 128);
  }
}

TEST(MatchPlanes, OutsideReachesOnePixel) {
  const auto gray = test::constant<std::uint8_t>({6, 5}, 7);
  auto inside = test::constant<std::uint8_t>({6, 5}, 255);
  inside.at(2, 1) = 0;
  PlaneImages out(gray.size(), 0);
  ref::match_planes(gray, inside, 0, false, out);
  for (int y = 0; y < 5; ++y)
    for (int x = 0; x < 6; ++x)
      EXPECT_EQ(out.outside.at(y, x), std::abs(y - 2) <= 1 && std::abs(x - 1) <= 1 ? 255 : 0) << y << " " << x;
}

TEST(MatchPlanes, SimdAgrees) {
  std::mt19937 rng(8);
  Pool two(2);
  for (const Size size : test::awkward_sizes())
    for (const test::Fill how : test::kFills)
      for (const bool masked : {false, true}) {
        const bool clear = rng() % 2 == 0;
        test::Tight<std::uint8_t> gray(size), inside(size);
        test::fill(gray.view, how, rng);
        for (int y = 0; y < size.height; ++y)
          for (int x = 0; x < size.width; ++x) inside.view.at(y, x) = rng() % 9 ? 255 : 0;
        const View<const std::uint8_t> mask = masked ? View<const std::uint8_t>(inside.view) : View<const std::uint8_t>{};
        const int dead_zone = masked ? 9 : 0;
        PlaneImages want(size, 64);
        ref::match_planes(gray.view, mask, dead_zone, clear, want);
        test::each_target([&](const std::string& target) {
          PlaneImages got(size, 64);
          simd::match_planes(two, gray.view, mask, dead_zone, clear, size.height, got);
          for (std::size_t i = 0; i < 2; ++i)
            test::expect_same<std::uint8_t>(want.census[i], got.census[i], "census " + target);
          for (std::size_t i = 0; i < 3; ++i) {
            test::expect_same<std::uint8_t>(want.value[i], got.value[i], "value " + target);
            test::expect_same<std::uint8_t>(want.low[i], got.low[i], "low " + target);
            test::expect_same<std::uint8_t>(want.high[i], got.high[i], "high " + target);
          }
          test::expect_same<std::uint8_t>(want.outside, got.outside, "outside " + target);
        });
        if (::testing::Test::HasFailure()) return;
      }
}

}  // namespace
}  // namespace duo
