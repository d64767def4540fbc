#include "stages/blur/blur.h"

#include "stages/types/clear.h"
#include "tests/agree.h"

namespace duo {
namespace {

Image<std::uint8_t> noise(Size size, unsigned seed) {
  std::mt19937 rng(seed);
  Image<std::uint8_t> out(size);
  for (int y = 0; y < size.height; ++y)
    for (int x = 0; x < size.width; ++x) out.at(y, x) = static_cast<std::uint8_t>(90 + rng() % 31);
  return out;
}

/// The mean of 2x2 pixels.
Image<std::uint8_t> softer(const Image<std::uint8_t>& from) {
  Image<std::uint8_t> out(from.size());
  for (int y = 0; y < out.height(); ++y)
    for (int x = 0; x < out.width(); ++x) {
      const int y2 = std::min(y + 1, out.height() - 1), x2 = std::min(x + 1, out.width() - 1);
      out.at(y, x) = static_cast<std::uint8_t>((from.at(y, x) + from.at(y, x2) + from.at(y2, x) + from.at(y2, x2) + 2) / 4);
    }
  return out;
}

// By hand: a pixel 5 above the others in the block's middle makes differences of 20, four of -10 and four of 5 around it among
// neighbours: 80 in all, bin 20. Three pixels apart the same nine lie around (6, 6); those at 3 and 9 are inside the block,
// which has columns 3 .. 10: 80 as well. Ratio 1. Alone in a corner, at (3, 3), five of nine lie outside: near 20 + 2 * 10 + 5
// = 45, bin 11; three apart (3, 3), (3, 6), (6, 3), (6, 6): the same. Two pixels side by side, 5 above, tell the distances
// apart: near the columns' sums are 5 (1, -1, -1, 1), each weighed 1, 2, 1: 4 * 4 * 5 = 80; three apart both stand alone: 160.
// 16 * 81 / 41 = 31.
TEST(Blur, HandWorked) {
  auto picture = test::constant<std::uint8_t>({14, 14}, 50);
  EXPECT_EQ(ref::blur_q4(picture, picture), kBlurUnknown) << "flat";
  picture.at(6, 6) = 55;
  EXPECT_EQ(ref::blur_q4(picture, picture), 16);
  picture.at(6, 7) = 55;
  EXPECT_EQ(ref::blur_q4(picture, picture), 31);
  // The more blurred view counts, whichever it is.
  auto sharp = test::constant<std::uint8_t>({14, 14}, 50);
  sharp.at(6, 6) = 55;
  EXPECT_EQ(ref::blur_q4(picture, sharp), 31);
  EXPECT_EQ(ref::blur_q4(sharp, picture), 31);
  // What saturates in the block takes it out, and beside the block does not.
  sharp.at(11, 11) = 255;
  EXPECT_NE(ref::blur_q4(sharp, sharp), kBlurUnknown);
  sharp.at(10, 10) = 255;
  EXPECT_EQ(ref::blur_q4(sharp, sharp), kBlurUnknown);
  const auto small = noise({13, 40}, 1);
  EXPECT_EQ(ref::blur_q4(small, small), kBlurUnknown);
}

TEST(Blur, TellsSoftPicturesFromSharpOnes) {
  const auto sharp = noise({320, 240}, 3), soft = softer(sharp), softest = softer(soft);
  EXPECT_NEAR(ref::blur_q4(sharp, sharp), 16, 2) << "white noise";
  EXPECT_LT(ref::blur_q4(sharp, sharp), kClearBlur_q4);
  EXPECT_GT(ref::blur_q4(softest, softest), kClearBlur_q4);
  EXPECT_GT(ref::blur_q4(softest, softest), ref::blur_q4(soft, soft));
}

// The first pair decides, 30 others in a row change it, and one that agrees makes them begin anew.
TEST(Clear, AStreamDoesNotFlicker) {
  for (const bool first : {false, true}) {
    int known = next_clear(0, first);
    EXPECT_EQ(known > 0, first);
    for (int i = 1; i < kClearPatience; ++i) EXPECT_EQ((known = next_clear(known, !first)) > 0, first) << i;
    known = next_clear(known, first);
    for (int i = 1; i < kClearPatience; ++i) EXPECT_EQ((known = next_clear(known, !first)) > 0, first) << i;
    known = next_clear(known, !first);
    EXPECT_EQ(known > 0, !first);
    EXPECT_EQ(next_clear(known, first) > 0, !first);
  }
}

TEST(Blur, SimdAgrees) {
  std::mt19937 rng(5);
  std::vector<Size> sizes = test::awkward_sizes();
  sizes.insert(sizes.end(), {{13, 40}, {14, 14}, {21, 29}, {22, 30}, {269, 30}, {270, 45}, {271, 46}, {600, 62}});
  for (const int threads : {1, 3}) {
    Pool pool(threads);
    for (const Size size : sizes) {
      for (const test::Fill how : test::kFills) {
        test::Tight<std::uint8_t> left(size), right(size);
        test::fill(left.view, how, rng);
        test::fill(right.view, test::Fill::kLow, rng);
        EXPECT_EQ(simd::blur_q4(pool, left.view, right.view), ref::blur_q4(left.view, right.view))
            << size.width << "x" << size.height;
      }
      const auto left = softer(noise(size, 1)), right = noise(size, 2);
      EXPECT_EQ(simd::blur_q4(pool, left, right), ref::blur_q4(left, right)) << size.width << "x" << size.height;
    }
  }
}

}  // namespace
}  // namespace duo
