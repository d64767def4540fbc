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
        simd::balance(two, pair, got.view);
        test::expect_same<std::uint8_t>(want.view, got.view, "balance simd");
      }
}

}  // namespace
}  // namespace duo
