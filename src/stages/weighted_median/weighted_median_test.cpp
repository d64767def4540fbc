#include "stages/weighted_median/weighted_median.h"

#include <cmath>

#include "tests/agree.h"

namespace duo {
namespace {

constexpr int kHole = Disparity::kNone;

Image<std::uint16_t> median(const WeightedMedian& in) {
  Image<std::uint16_t> dst(in.d_q4.size());
  ref::weighted_median(in, dst);
  return dst;
}

TEST(WeightedMedian, WeightsFollowTheirFormula) {
  for (int i = 0; i < 16; ++i) EXPECT_EQ(WeightedMedian::kWeights[i], std::lround(64 * std::exp(-(4 * i + 1.5) / 14))) << i;
}

// By hand: each corner's taps are the four corners, 10 20 40 50, equal weights: up to 20 is half. Edge centres have two taps,
// of which the smaller is half; the centre has only itself.
TEST(WeightedMedian, TapsAreEverySecondPixel) {
  const auto d = test::image<std::uint16_t>({{50, 3, 10}, {6, 90, 4}, {20, 8, 40}});
  const auto guide = test::constant<std::uint8_t>({3, 3}, 80);
  test::expect_same<std::uint16_t>(test::image<std::uint16_t>({{20, 3, 20}, {4, 90, 4}, {20, 3, 20}}), median({d, guide}),
                                   "3x3");
}

// By hand, x = 6: taps 0 2 4 6 8 10 12 with guide differences 10 10 3 0 20 63 64, weights 32 32 57 57 14 1 0: 193 in all. In
// the order of values: 32 + 32 + 14 = 78, and 79 with the 1: less than half; + 57 = 136: more. The seventh pixel on either side
// is too far.
TEST(WeightedMedian, LikeGrayWeighsMore) {
  const auto d = test::image<std::uint16_t>({{1, 0, 1, 0, 9, 0, 8, 0, 2, 0, 3, 0, 4, 0}});
  const auto guide = test::image<std::uint8_t>({{90, 0, 110, 0, 103, 0, 100, 0, 80, 0, 163, 0, 164, 0}});
  EXPECT_EQ(median({d, guide}).at(0, 6), 8);
}

TEST(WeightedMedian, HolesStayAndDoNotCount) {
  const auto d = test::image<std::uint16_t>({{kHole, kHole, 7, kHole, 9}});
  const auto guide = test::constant<std::uint8_t>({5, 1}, 80);
  const auto want = test::image<std::uint16_t>({{kHole, kHole, 7, kHole, 7}});
  test::expect_same<std::uint16_t>(want, median({d, guide}), "holes");
}

// A surface of 100 beside one of 900; one pixel of the first took the other's value. It comes back, and the edge stays where
// the picture has it.
TEST(WeightedMedian, GuideEdgeSeparates) {
  Image<std::uint16_t> want({20, 15});
  Image<std::uint8_t> guide(want.size());
  for (int y = 0; y < 15; ++y)
    for (int x = 0; x < 20; ++x) want.at(y, x) = x < 9 ? 100 : 900, guide.at(y, x) = x < 9 ? 50 : 114;
  auto d = want.clone();
  d.at(7, 8) = 900;
  test::expect_same<std::uint16_t>(want, median({d, guide}), "edge");
}

void agree(const WeightedMedian& in, const std::string& what) {
  static Pool one(1), two(2);
  const Size size = in.d_q4.size();
  test::Tight<std::uint16_t> want(size);
  ref::weighted_median(in, want.view);
  test::each_target([&](const std::string& target) {
    simd::WeightedMedianScratch scratch(size);
    for (Pool* pool : {&one, &two}) {
      test::Tight<std::uint16_t> got(size);
      simd::weighted_median(*pool, in, scratch, got.view);
      test::expect_same<std::uint16_t>(want.view, got.view,
                                       what + " simd " + target + " threads " + std::to_string(pool->threads()));
    }
  });
}

/// Values of every kind with holes among them, and of few gray values so that all weights occur.
struct Inputs {
  test::Tight<std::uint16_t> d_q4;
  test::Tight<std::uint8_t> guide;

  Inputs(Size size, test::Fill how, std::mt19937& rng) : d_q4(size), guide(size) {
    test::fill(d_q4.view, how, rng);
    test::fill(guide.view, rng() % 2 ? test::Fill::kRandom : how, rng);
    const int contrast = rng() % 2 ? 255 : 63;
    for (int y = 0; y < size.height; ++y)
      for (int x = 0; x < size.width; ++x) {
        if (rng() % 5 == 0) d_q4.view.at(y, x) = Disparity::kNone;
        guide.view.at(y, x) &= contrast;
      }
  }
};

TEST(WeightedMedian, SimdAgrees) {
  std::mt19937 rng(21);
  auto sizes = test::awkward_sizes();
  sizes.insert(sizes.end(), {{6, 14}, {7, 7}, {13, 13}, {32, 12}, {70, 20}});
  for (const Size size : sizes)
    for (const test::Fill how : test::kFills) {
      const Inputs in(size, how, rng);
      agree({in.d_q4.view, in.guide.view}, "weighted median");
      if (HasFailure()) return;
    }
}

// The scratch keeps nothing of the frame before: its holes are not the next one's.
TEST(WeightedMedian, ScratchIsUsedAgain) {
  std::mt19937 rng(22);
  Pool pool(1);
  const Size size{67, 11};
  simd::WeightedMedianScratch scratch(size);
  for (int frame = 0; frame < 3; ++frame) {
    const Inputs in(size, test::Fill::kRandom, rng);
    Image<std::uint16_t> got(size);
    simd::weighted_median(pool, {in.d_q4.view, in.guide.view}, scratch, got);
    test::expect_same<std::uint16_t>(median({in.d_q4.view, in.guide.view}), got, "frame " + std::to_string(frame));
  }
}

}  // namespace
}  // namespace duo
