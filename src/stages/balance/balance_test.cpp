#include "stages/balance/balance.h"

#include <cmath>
#include <functional>

#include "tests/agree.h"

namespace duo {
namespace {

/// A picture of cells of one value each.
Image<std::uint8_t> of_cells(Size cells, const std::function<int(int y, int x)>& value) {
  Image<std::uint8_t> out({cells.width * kBalanceCell, cells.height * kBalanceCell});
  for (int y = 0; y < out.height(); ++y)
    for (int x = 0; x < out.width(); ++x) out.at(y, x) = static_cast<std::uint8_t>(value(y / kBalanceCell, x / kBalanceCell));
  return out;
}

/// Cells of 40 .. 167 that look like no others; x is below 32.
int pattern(int y, int x) {
  std::mt19937 rng(static_cast<unsigned>(32 * y + x));
  return 40 + static_cast<int>(rng() % 128);
}

Image<std::uint8_t> balanced(const GrayPair& pair, int max_disparity) {
  Image<std::uint8_t> dst(pair.size());
  ref::balance(pair, max_disparity, 0, dst);
  return dst;
}

// By hand: left 10 and 30 have mean 20, right 20 and 60 have mean 40 and twice the spread: gain 1/2, offset 0.
TEST(Balance, HandWorked) {
  EXPECT_EQ(balance_table({}, 0)[7], 7) << "no pairs: nothing changes";
  BrightnessPair sums;
  for (int i = 0; i < kBalanceFewest; ++i) sums.left.add(i % 2 == 0 ? 10 : 30), sums.right.add(i % 2 == 0 ? 20 : 60);
  const auto table = balance_table(sums, 0);
  for (int v = 0; v < 256; v += 2) EXPECT_EQ(table[static_cast<std::size_t>(v)], v / 2);
}

// By hand: means of 100 and 108 shift by 8 levels and no more: left alone where that much is; with 109 they are not.
TEST(Balance, LittleIsLeftAlone) {
  for (const int by : {8, 9}) {
    BrightnessPair sums;
    for (int i = 0; i < kBalanceFewest; ++i) sums.left.add(100 + by), sums.right.add(100);
    EXPECT_EQ(balance_table(sums, 7)[100], 100 + by);
    EXPECT_EQ(balance_table(sums, 8)[100], by == 8 ? 100 : 109);
    EXPECT_EQ(balance_table(sums, 0)[100], 100 + by);
  }
}

// The right view is 2 cells to the right of the left one and half as bright. Moments of the whole pictures would be drawn
// towards the bright wall that only the left one sees, at its right side.
TEST(Balance, WhatOneViewAloneSeesDoesNotCount) {
  const Size cells{24, 16};
  const auto left = of_cells(cells, [](int y, int x) { return x < 16 ? pattern(y, x) : 200 + pattern(y, x) / 4; });
  const auto right = of_cells(cells, [](int y, int x) { return x < 14 ? pattern(y, x + 2) / 2 + 5 : pattern(x, y) / 8; });
  const auto got = balanced({left, right}, 32);
  for (int x = 8; x < 13 * 8; ++x) EXPECT_NEAR(got.at(60, x), left.at(60, x + 16), 8) << x;
}

TEST(Balance, GainAndOffsetComeBack) {
  const Size cells{24, 12};
  const auto left = of_cells(cells, [](int y, int x) { return pattern(y, x); });
  const auto right = of_cells(cells, [](int y, int x) { return static_cast<int>(std::lround(0.8 * pattern(y, x + 3) + 10)); });
  const auto got = balanced({left, right}, 32);
  for (int x = 0; x < 20 * 8; x += 8) EXPECT_NEAR(got.at(40, x), left.at(40, x + 24), 1) << x;
}

// The left camera is overexposed: what it cuts off at 255 says nothing of the gain, 2.
TEST(Balance, WhatIsCutOffDoesNotCount) {
  const Size cells{24, 24};
  const auto left = of_cells(cells, [](int y, int x) { return std::min(255, 2 * pattern(y, x)); });
  const auto right = of_cells(cells, [](int y, int x) { return pattern(y, x + 1); });
  const auto got = balanced({left, right}, 16);
  for (int x = 8; x < 20 * 8; x += 8) {
    if (left.at(80, x + 8) >= 240) continue;
    EXPECT_NEAR(got.at(80, x), left.at(80, x + 8), 3) << x;
  }
}

TEST(Balance, OutsideDoesNotCount) {
  const Size cells{24, 12};
  const auto left = of_cells(cells, [](int y, int x) { return x < 12 ? pattern(y, x) : 255; });
  const auto right = of_cells(cells, [](int y, int x) { return x < 12 ? pattern(y, x) - 30 : pattern(y, x) / 4; });
  const auto inside = of_cells(cells, [](int, int x) { return x < 12 ? 255 : 0; });
  const auto got = balanced({left, right, inside, inside}, 16);
  for (int x = 0; x < 12 * 8; x += 8) EXPECT_EQ(got.at(40, x), left.at(40, x)) << x;
}

TEST(Balance, FlatPicturesAreShifted) {
  const auto left = test::constant<std::uint8_t>({64, 80}, 90), right = test::constant<std::uint8_t>({64, 80}, 30);
  test::expect_same<std::uint8_t>(left, balanced({left, right}, 16), "balance flat");
}

TEST(Balance, NothingInsideChangesNothing) {
  const auto left = test::constant<std::uint8_t>({64, 40}, 90), right = test::constant<std::uint8_t>({64, 40}, 30),
             none = test::constant<std::uint8_t>({64, 40}, 0);
  test::expect_same<std::uint8_t>(right, balanced({left, right, none, none}, 16), "balance none");
}

// By hand: left 0 .. 255 once each; right only 100 and 101, deviation 1/2 and mean 100 1/2. Deviation of the left
// sqrt((256^2 - 1) / 12) = 73.9002, mean 127 1/2: gain 147.8004, 100 becomes 53.6, 101 becomes 201.4, and all else is cut.
TEST(Balance, LargeGainIsCut) {
  BrightnessPair sums;
  for (int i = 0; i < 256; ++i) sums.left.add(i), sums.right.add(100 + i % 2);
  const auto table = balance_table(sums, 0);
  EXPECT_EQ(table[99], 0);
  EXPECT_EQ(table[100], 54);
  EXPECT_EQ(table[101], 201);
  EXPECT_EQ(table[102], 255);
}

// As many cells as there may be, black and white on the left, one that differs on the right: nothing wraps.
TEST(Balance, SumsAtTheBounds) {
  constexpr std::int64_t kMost = 1 << 23;
  const BrightnessSums half{kMost, kMost / 2 * 255, kMost / 2 * 255 * 255}, one{kMost, 1, 1};
  EXPECT_EQ(balance_table({half, one}, 0)[0], 128);  // 127.5, as the mean of the right one rounds to 0
  EXPECT_EQ(balance_table({half, one}, 0)[1], 255);
  EXPECT_EQ(balance_table({one, half}, 0)[255], 0);
}

// Random pictures have no cells in common: here all but the borders' see the same, 16 px apart, and the balance does something.
TEST(Balance, SimdAgreesWhereCellsFindEachOther) {
  Pool two(2);
  for (const Size cells : {Size{24, 12}, Size{31, 17}, Size{9, 40}})
    for (const bool masked : {false, true}) {
      const auto left = of_cells(cells, [](int y, int x) { return pattern(y, x); });
      const auto right = of_cells(cells, [](int y, int x) { return (3 * pattern(y, x + 2) + 1) / 4 + 9; });
      const auto inside = of_cells(cells, [](int y, int x) { return y == 1 && x == 1 ? 0 : 255; });
      GrayPair pair{left, right};
      if (masked) pair.left_inside = pair.right_inside = inside;
      BalanceScratch scratch(left.size());
      Image<std::uint8_t> got(left.size());
      const auto want = balanced(pair, 40);
      ASSERT_NE(want.at(24, 24), right.at(24, 24));
      test::each_target([&](const std::string& target) {
        simd::balance(two, pair, 40, 0, scratch, got);
        test::expect_same<std::uint8_t>(want, got, "balance of cells " + target);
      });
    }
}

TEST(Balance, SimdAgrees) {
  std::mt19937 rng(5);
  Pool two(2);
  std::vector<Size> sizes = test::awkward_sizes();
  for (const Size size : {Size{8, 8}, Size{39, 41}, Size{640, 48}, Size{531, 77}}) sizes.push_back(size);
  for (const Size size : sizes) {
    BalanceScratch scratch(size);
    for (const test::Fill how : test::kFills)
      for (const bool masked : {false, true}) {
        test::Tight<std::uint8_t> left(size), right(size), inside(size), want(size), got(size);
        test::fill(left.view, how, rng);
        test::fill(right.view, test::Fill::kRandom, rng);
        test::fill(inside.view, test::Fill::kHigh, rng);
        for (int hole = 0; hole < 3; ++hole)
          inside.view.at(static_cast<int>(rng() % static_cast<unsigned>(size.height)),
                         static_cast<int>(rng() % static_cast<unsigned>(size.width))) = 0;
        GrayPair pair{left.view, right.view};
        if (masked) pair.left_inside = pair.right_inside = inside.view;
        for (const int max_disparity : {1, 64, 256}) {
          const int unbalanced = max_disparity == 64 ? 255 : 0;
          ref::balance(pair, max_disparity, unbalanced, want.view);
          test::each_target([&](const std::string& target) {
            simd::balance(two, pair, max_disparity, unbalanced, scratch, got.view);
            test::expect_same<std::uint8_t>(want.view, got.view, "balance " + target);
          });
        }
      }
  }
}

}  // namespace
}  // namespace duo
