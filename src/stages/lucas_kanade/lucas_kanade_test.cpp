#include "stages/lucas_kanade/lucas_kanade.h"

#include <cmath>

#include "tests/agree.h"

namespace duo {
namespace {

constexpr int kNoDisparity = Disparity::kNone;

/// A zigzag of slope 16 from 0 up to 64 and back, at any place.
double zigzag(double x) {
  const double in_period = std::fmod(x + 80, 8);
  return 16 * std::min(in_period, 8 - in_period);
}

/// Two rows of it, which the left view sees `true_px` further right than the right view.
struct ZigzagPair {
  Image<std::uint8_t> left{{14, 2}}, right{{14, 2}};
  Image<std::uint16_t> d_q4{{14, 2}};
  ZigzagPair(double true_px, int d) {
    for (const int y : {0, 1})
      for (int x = 0; x < 14; ++x) {
        left.at(y, x) = static_cast<std::uint8_t>(std::lround(zigzag(x - true_px)));
        right.at(y, x) = static_cast<std::uint8_t>(std::lround(zigzag(x)));
        d_q4.at(y, x) = static_cast<std::uint16_t>(d);
      }
  }
  Image<std::uint16_t> stepped(int max_disparity = 16) const {
    Image<std::uint16_t> out(d_q4.size());
    ref::lucas_kanade({left, right, d_q4, max_disparity}, out);
    return out;
  }
};

// By hand: 4096 * 64 / (64 * 64 + 128) = 62.06 and 4096 * 8 / 192 = 170.7; 455 * 8192 / 4224 = 882.4, / 192 = 19413.3;
// 455 * 64 * 64 / 4224 = 441.2, 455 * 64 / 192 = 151.7, and a 20th of 455 is 22.75. Where one view has no gradient the other's
// is noise, or the views differ: only the 20th is left.
TEST(LucasKanade, GradientsCountAlmostAlike) {
  EXPECT_EQ(lucas_kanade_pull(0), 0);
  EXPECT_EQ(lucas_kanade_inverse(0), 29120);
  EXPECT_EQ(lucas_kanade_weight(0, 29120), 23);
  EXPECT_EQ(lucas_kanade_pull(8), 171);
  EXPECT_EQ(lucas_kanade_inverse(8), 19413);
  EXPECT_EQ(lucas_kanade_weight(64, 19413), 152 + 23);
  EXPECT_EQ(lucas_kanade_pull(64), 62);
  EXPECT_EQ(lucas_kanade_inverse(64), 882);
  EXPECT_EQ(lucas_kanade_weight(64 * 64, 882), 441 + 23);
}

// By hand: column 8, whose taps are the columns 4, 6 .. 12. Going up e is -64, going down 64; g is 64, where the right view
// turns 8, of the left view alone. So of five taps three have -64 * 62 and 464, two -64 * 171 and 23: in all -33792 and 1438,
// and (2 * 33792 / 1438 + 1) / 2 = 23 sixteenths, of which 6 are taken: the turns say most.
TEST(LucasKanade, StepsToWhereBothViewsAreAlike) {
  const ZigzagPair pair(2.25, 32);
  const LucasKanade in{pair.left, pair.right, pair.d_q4, 16};
  const int pull[] = {-64 * 62, -64 * 171, -64 * 62, -64 * 171, -64 * 62}, weight[] = {464, 23, 464, 23, 464};
  for (int i = 0; i < 5; ++i) {
    const LucasKanadeSums tap = ref::lucas_kanade_tap(in, 0, 4 + 2 * i);
    EXPECT_EQ(tap.pull, pull[i]) << i;
    EXPECT_EQ(tap.weight, weight[i]) << i;
  }
  EXPECT_EQ(pair.stepped().at(0, 8), 38);
  EXPECT_EQ(ZigzagPair(2, 32).stepped().at(0, 8), 32);
}

// By hand: 2 * 1000 / 110 = 18, nine sixteenths: six are the most. And the range is not left.
TEST(LucasKanade, IsHeld) {
  EXPECT_EQ((LucasKanadeSums{-1000, 110}).step_q4(), 6);
  EXPECT_EQ((LucasKanadeSums{1000, 400}).step_q4(), -3);
  EXPECT_EQ(LucasKanadeSums().step_q4(), 0);
  EXPECT_EQ(ZigzagPair(2.25, 32).stepped(3).at(0, 8), 32);
}

// A shaded surface without any texture tells its place, too: -2 levels on a slope of 16 are an eighth of a pixel, and two
// and a quarter times that: (2 * 32 * 62 / 464 + 1) / 2 = 4 sixteenths.
TEST(LucasKanade, ShadingTellsThePlace) {
  ZigzagPair slope(2, 32);
  for (const int y : {0, 1})
    for (int x = 0; x < 14; ++x)
      slope.right.at(y, x) = static_cast<std::uint8_t>(16 * x),
                        slope.left.at(y, x) = static_cast<std::uint8_t>(std::max(16 * x - 34, 0));
  EXPECT_EQ(slope.stepped().at(0, 8), 36);
}

TEST(LucasKanade, WhatSeesSomethingElseDoesNotCount) {
  ZigzagPair pair(2.25, 32);
  pair.left.at(0, 12) = 200;  // a tap that differs by too much
  const LucasKanade in{pair.left, pair.right, pair.d_q4, 16};
  EXPECT_EQ(ref::lucas_kanade_tap(in, 0, 12).weight, 0);
  pair.d_q4.at(0, 10) = kNoDisparity;
  EXPECT_EQ(ref::lucas_kanade_tap(in, 0, 10).weight, 0);
  EXPECT_EQ(pair.stepped().at(0, 10), kNoDisparity);
  // Places whose neighbours lie outside either picture.
  for (const int x : {0, 2}) EXPECT_EQ(ref::lucas_kanade_tap(in, 0, x).weight, 0) << x;
  EXPECT_GT(ref::lucas_kanade_tap(in, 0, 4).weight, 0);
}

TEST(LucasKanade, TapsAreEachFourthPixel) {
  const auto steps = [](int y, int x) {
    ZigzagPair pair(2, 32);
    pair.left.at(y, x) += 4;  // a tap here, but also in the gradients of both beside it, whose e is 0
    return pair.stepped();
  };
  const Image<std::uint16_t> still = ZigzagPair(2, 32).stepped();
  for (const int y : {0, 1})
    for (const int x : {4, 5}) EXPECT_EQ(steps(y, x).at(0, 6) == still.at(0, 6), y % 2 != 0 || x % 2 != 0) << y << " " << x;
}

/// Pictures and disparities of every kind, with holes among these.
struct LikeViews {
  test::Tight<std::uint8_t> left, right;
  test::Tight<std::uint16_t> d_q4;

  LikeViews(Size size, test::Fill how, std::mt19937& rng) : left(size), right(size), d_q4(size) {
    test::fill(left.view, how, rng);
    test::fill(right.view, rng() % 2 ? test::Fill::kRandom : how, rng);
    const int contrast = rng() % 2 ? 255 : 15, most = rng() % 2 ? 16 * 60 : 40;
    for (int y = 0; y < size.height; ++y)
      for (int x = 0; x < size.width; ++x) {
        d_q4.view.at(y, x) = static_cast<std::uint16_t>(rng() % 6 == 0 ? static_cast<unsigned>(kNoDisparity)
                                                                       : rng() % static_cast<unsigned>(most));
        left.view.at(y, x) &= static_cast<std::uint8_t>(contrast);
        right.view.at(y, x) &= static_cast<std::uint8_t>(contrast);
      }
  }
};

TEST(LucasKanade, SimdAgrees) {
  std::mt19937 rng(31);
  Pool one(1), two(2);
  auto sizes = test::awkward_sizes();
  sizes.insert(sizes.end(), {{6, 14}, {32, 12}, {70, 20}, {4200, 3}});  // beyond column 4096 a hole's place is in the picture
  for (const Size size : sizes)
    for (const test::Fill how : test::kFills) {
      const LikeViews inputs(size, how, rng);
      const LucasKanade in{inputs.left.view, inputs.right.view, inputs.d_q4.view, 61};
      test::Tight<std::uint16_t> want(size);
      ref::lucas_kanade(in, want.view);
      test::each_target([&](const std::string& target) {
        simd::LucasKanadeScratch scratch(size, 2);
        for (Pool* pool : {&one, &two})
          for (int turn = 0; turn < 2; ++turn) {  // the scratch keeps nothing
            test::Tight<std::uint16_t> got(size);
            simd::lucas_kanade(*pool, in, scratch, got.view);
            test::expect_same<std::uint16_t>(want.view, got.view,
                                             "lucas_kanade simd " + target + " threads " + std::to_string(pool->threads()));
          }
      });
      if (HasFailure()) return;
    }
}

// For the address sanitizer.
TEST(LucasKanade, NothingBehindNarrowPicturesIsRead) {
  for (const int width : {3, 4, 5}) {
    const Size size{width, 1};
    const std::vector<std::uint8_t> row(static_cast<std::size_t>(width), 7);
    const std::vector<std::uint16_t> d_q4(row.size());
    std::vector<std::uint16_t> out(row.size(), 1);
    Pool pool(1);
    simd::LucasKanadeScratch scratch(size, 1);
    const View<const std::uint8_t> gray(row.data(), size, width);
    simd::lucas_kanade(pool, {gray, gray, {d_q4.data(), size, width}, 2}, scratch, {out.data(), size, width});
    EXPECT_EQ(out, d_q4) << width;
  }
}

TEST(LucasKanade, OnlyRowsThatAreNeeded) {
  std::mt19937 rng(32);
  const Size size{70, 40};
  const LikeViews inputs(size, test::Fill::kRandom, rng);
  Image<std::uint16_t> whole(size), part(size);
  ref::lucas_kanade({inputs.left.view, inputs.right.view, inputs.d_q4.view, 61}, whole);
  Pool pool(2);
  simd::LucasKanadeScratch scratch(size, 2);
  const RowBand rows{11, 29};
  simd::lucas_kanade(pool, {inputs.left.view, inputs.right.view, inputs.d_q4.view, 61, rows}, scratch, part);
  test::expect_same<std::uint16_t>(rows.of(View<const std::uint16_t>(whole)), rows.of(View<const std::uint16_t>(part)), "rows");
}

}  // namespace
}  // namespace duo
