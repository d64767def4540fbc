#include "stages/match_around/match_around.h"

#include "stages/halve/halve.h"
#include "tests/agree.h"

namespace duo {
namespace {

// The right picture is the left one moved by three pixels; every interior pixel must find 3, at the lowest level and around 2
// * 1.
TEST(MatchAround, FindsAShift) {
  std::mt19937 rng(5);
  Image<std::uint8_t> left({40, 20}), right({40, 20});
  test::fill(left.view(), test::Fill::kRandom, rng);
  for (int y = 0; y < 20; ++y)
    for (int x = 0; x < 40; ++x) right.at(y, x) = left.at(y, std::min(x + 3, 39));
  const Image<std::int16_t> coarser = test::constant<std::int16_t>({20, 10}, 1);
  Image<std::int16_t> dst(left.size());
  ref::match_around({.left = left, .right = right}, dst);
  for (int y = 0; y < 20; ++y)
    for (int x = 6; x < 33; ++x) EXPECT_EQ(dst.at(y, x), 3);
  ref::match_around({.left = left, .right = right, .coarser = coarser, .radius = 3}, dst);
  for (int y = 0; y < 20; ++y)
    for (int x = 6; x < 33; ++x) EXPECT_EQ(dst.at(y, x), 3);
}

// By hand, one row, candidates -1, 0, 1 at x = 1. Columns -2 .. 4 of L with the edges repeated: 10 10 10 20 30 30 30.
//   d = -1  R(x + 1) = 20 20 30 40 40 40 40   costs 10 10 15 15 10 10 10 = 80   (half-way values 25 and 35 save 5 twice)
//   d =  0  R(x)     = 20 20 20 30 40 40 40   costs 10 10 10  5  5 10 10 = 60
//   d =  1  R(x - 1) = 20 20 20 20 30 40 40   costs 10 10 10  0  0  5 10 = 45   the least; seven equal rows each
TEST(MatchAround, HandWorkedCosts) {
  const auto left = test::image<std::uint8_t>({{10, 20, 30}});
  const auto right = test::image<std::uint8_t>({{20, 30, 40}});
  const Image<std::int16_t> coarser = test::constant<std::int16_t>({2, 1}, 0);
  Image<std::int16_t> dst(left.size());
  ref::match_around({.left = left, .right = right, .coarser = coarser, .radius = 1}, dst);
  EXPECT_EQ(dst.at(0, 1), 1);
}

// A flat picture ties everywhere: the smallest candidate wins.
TEST(MatchAround, TieGoesToTheSmallest) {
  const auto flat = test::constant<std::uint8_t>({12, 8}, 90);
  const Image<std::int16_t> coarser = test::constant<std::int16_t>({6, 4}, 2);
  Image<std::int16_t> dst(flat.size());
  ref::match_around({.left = flat, .right = flat, .coarser = coarser, .radius = 2}, dst);
  EXPECT_EQ(dst.at(4, 6), 2);
}

// Outside pixels never match: with the true position of the right picture outside, another candidate wins.
TEST(MatchAround, OutsideNeverMatches) {
  std::mt19937 rng(6);
  Image<std::uint8_t> left({40, 20});
  test::fill(left.view(), test::Fill::kRandom, rng);
  const Image<std::uint8_t> inside = test::constant<std::uint8_t>({40, 20}, 255);
  Image<std::uint8_t> right_inside = inside.clone();
  for (int y = 0; y < 20; ++y)
    for (int x = 10; x < 30; ++x) right_inside.at(y, x) = 0;
  const Image<std::int16_t> coarser = test::constant<std::int16_t>({20, 10}, 0);
  Image<std::int16_t> dst(left.size());
  ref::match_around(
      {.left = left, .right = left, .left_inside = inside, .right_inside = right_inside, .coarser = coarser, .radius = 12},
      dst);
  EXPECT_EQ(dst.at(10, 5), 0);
  EXPECT_NE(dst.at(10, 20), 0);
}

// The thesis's count for 640x480 is 80*60*80 + 160*120*7 + 320*240*13 + 640*480*25; here the same on an eighth of the sides.
TEST(MatchAround, CountsItsComparisons) {
  std::int64_t comparisons = 0;
  Image<std::int16_t> coarser;
  Size sizes[4] = {{10, 8}, {20, 16}, {40, 32}, {80, 64}};
  for (int level = 0; level < 4; ++level) {
    const Image<std::uint8_t> flat(sizes[level]);
    Image<std::int16_t> dst(sizes[level]);
    const View<const std::int16_t> below = level == 0 ? View<const std::int16_t>() : View<const std::int16_t>(coarser);
    ref::match_around({.left = flat, .right = flat, .coarser = below, .radius = level == 0 ? 0 : 3 << (level - 1)}, dst,
                      &comparisons);
    coarser = std::move(dst);
  }
  EXPECT_EQ(comparisons, 10 * 8 * 10 + 20 * 16 * 7 + 40 * 32 * 13 + 80 * 64 * 25);
}

TEST(MatchAround, SimdAgrees) {
  std::mt19937 rng(7);
  std::size_t turn = 0;
  Pool one(1), two(2);
  for (const Size size : test::awkward_sizes())
    for (const int radius : {0, 1, 3, 6, 12, 15})  // 0 stands for the lowest level
      for (const bool masked : {false, true}) {
        const test::Fill how = test::kFills[turn++ % std::size(test::kFills)];  // in the end each with each radius
        test::Tight<std::uint8_t> left(size), right(size), left_inside(size), right_inside(size);
        test::fill(left.view, how, rng);
        test::fill(right.view, how, rng);
        for (int y = 0; y < size.height; ++y)
          for (int x = 0; x < size.width; ++x) {
            left_inside.view.at(y, x) = rng() % 5 ? 255 : 0;
            right_inside.view.at(y, x) = rng() % 5 ? 255 : 0;
          }
        test::Tight<std::int16_t> coarser(half_of(size)), want(size);
        for (int y = 0; y < coarser.view.height(); ++y)
          for (int x = 0; x < coarser.view.width(); ++x)
            coarser.view.at(y, x) = static_cast<std::int16_t>(rng() % 3 ? 4 : static_cast<int>(rng() % 200) - 100);
        MatchAround in{.left = left.view, .right = right.view, .radius = radius};
        if (masked) in.left_inside = left_inside.view, in.right_inside = right_inside.view;
        if (radius > 0) in.coarser = coarser.view;
        if (radius == 0 && size.width > 70) continue;  // the plain loops are slow there
        ref::match_around(in, want.view);
        test::each_target([&](const std::string& target) {
          for (Pool* pool : {&one, &two}) {
            test::Tight<std::int16_t> got(size);
            simd::MatchAroundScratch scratch(size);
            simd::match_around(*pool, in, scratch, got.view);
            test::expect_same<std::int16_t>(want.view, got.view,
                                            "match_around simd " + target + " radius " + std::to_string(radius));
          }
        });
        if (HasFailure()) return;
      }
}

}  // namespace
}  // namespace duo
