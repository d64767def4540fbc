#include "stages/balance/balance.h"

#include "tests/agree.h"

namespace duo {
namespace {

// By hand: left 10 20 30 has mean 20, right 20 40 60 has mean 40 and twice the spread: gain 1/2, offset 0.
TEST(Balance, HandWorked) {
  const auto left = test::image<std::uint8_t>({{10, 20, 30}}), right = test::image<std::uint8_t>({{20, 40, 60}});
  Image<std::uint8_t> dst(left.size());
  ref::balance({left, right}, dst);
  test::expect_same<std::uint8_t>(left, dst, "balance");
}

TEST(Balance, OutsideDoesNotCount) {
  const auto left = test::image<std::uint8_t>({{10, 20, 30, 255}}), right = test::image<std::uint8_t>({{20, 40, 60, 0}});
  const auto inside = test::image<std::uint8_t>({{255, 255, 255, 0}}), want = test::image<std::uint8_t>({{10, 20, 30, 0}});
  Image<std::uint8_t> dst(left.size());
  ref::balance({left, right, inside, inside}, dst);
  test::expect_same<std::uint8_t>(want, dst, "balance masked");
}

TEST(Balance, FlatPicturesAreShifted) {
  const auto left = test::constant<std::uint8_t>({4, 3}, 90), right = test::constant<std::uint8_t>({4, 3}, 30);
  Image<std::uint8_t> dst(left.size());
  ref::balance({left, right}, dst);
  test::expect_same<std::uint8_t>(left, dst, "balance flat");
}

TEST(Balance, NothingInsideChangesNothing) {
  const auto left = test::constant<std::uint8_t>({4, 3}, 90), right = test::constant<std::uint8_t>({4, 3}, 30),
             none = test::constant<std::uint8_t>({4, 3}, 0);
  Image<std::uint8_t> dst(left.size());
  ref::balance({left, right, none, none}, dst);
  test::expect_same<std::uint8_t>(right, dst, "balance none");
}

// By hand: left 0 .. 255 of one pixel each; right only 100 and 101, deviation 1/2 and mean 100 1/2. Deviation of the left
// sqrt((256^2 - 1) / 12) = 73.9002, mean 127 1/2: gain 147.8004, 100 becomes 53.6, 101 becomes 201.4, and all else is cut.
TEST(Balance, LargeGainIsCut) {
  Image<std::uint8_t> left({16, 16}), right(left.size());
  for (int i = 0; i < 256; ++i)
    left.at(i / 16, i % 16) = static_cast<std::uint8_t>(i), right.at(i / 16, i % 16) = static_cast<std::uint8_t>(100 + i % 2);
  const auto table = balance_table(brightness_sums(left, {}, 0, 16), brightness_sums(right, {}, 0, 16));
  EXPECT_EQ(table[99], 0);
  EXPECT_EQ(table[100], 54);
  EXPECT_EQ(table[101], 201);
  EXPECT_EQ(table[102], 255);
}

// As many pixels as there may be, black and white on the left, one that differs on the right: nothing wraps.
TEST(Balance, SumsAtTheBounds) {
  constexpr std::int64_t kMost = 1 << 23;
  const BrightnessSums half{kMost, kMost / 2 * 255, kMost / 2 * 255 * 255}, one{kMost, 1, 1};
  EXPECT_EQ(balance_table(half, one)[0], 128);  // 127.5, as the mean of the right one rounds to 0
  EXPECT_EQ(balance_table(half, one)[1], 255);
  EXPECT_EQ(balance_table(one, half)[255], 0);
}

TEST(Balance, SimdAgrees) {
  std::mt19937 rng(5);
  Pool two(2);
  for (const Size size : test::awkward_sizes())
    for (const test::Fill how : test::kFills)
      for (const bool masked : {false, true}) {
        test::Tight<std::uint8_t> left(size), right(size), inside(size), want(size), got(size);
        test::fill(left.view, how, rng);
        test::fill(right.view, test::Fill::kRandom, rng);
        test::fill(inside.view, test::Fill::kLow, rng);
        GrayPair pair{left.view, right.view};
        if (masked) pair.left_inside = pair.right_inside = inside.view;
        ref::balance(pair, want.view);
        test::each_target([&](const std::string& target) {
          simd::balance(two, pair, got.view);
          test::expect_same<std::uint8_t>(want.view, got.view, "balance " + target);
        });
      }
}

}  // namespace
}  // namespace duo
