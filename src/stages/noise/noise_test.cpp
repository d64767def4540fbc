#include "stages/noise/noise.h"

#include "tests/agree.h"

namespace duo {
namespace {

Image<std::uint8_t> noisy(Size size, double sigma, int slope, unsigned seed) {
  std::mt19937 rng(seed);
  std::normal_distribution<double> noise(0, sigma);
  Image<std::uint8_t> out(size);
  for (int y = 0; y < size.height; ++y)
    for (int x = 0; x < size.width; ++x)
      out.at(y, x) =
          static_cast<std::uint8_t>(std::clamp(std::lround(100 + slope * x % 64 + (sigma > 0 ? noise(rng) : 0)), 0L, 255L));
  return out;
}

// By hand: a pixel 10 above the others makes differences of 40, four of -20 and four of 10 around it: 160 in all, bin 10. Its
// middle, 168, times 3422 / 2^16 is 8.8: below what counts. 100 above makes 1600, bin 100, middle 1608: 84 sixteenths.
TEST(Noise, HandWorked) {
  auto picture = test::constant<std::uint8_t>({10, 10}, 50);
  picture.at(5, 5) = 60;
  EXPECT_EQ(ref::noise_q4(picture, picture), 0);
  picture.at(5, 5) = 150;
  EXPECT_EQ(ref::noise_q4(picture, picture), 84);
  // The right picture is the noisier one, and the other way round.
  EXPECT_EQ(ref::noise_q4(test::constant<std::uint8_t>({10, 10}, 50), picture), 84);
  EXPECT_EQ(ref::noise_q4(picture, test::constant<std::uint8_t>({10, 10}, 50)), 84);
  // Blocks end at (8, 8): what saturates beside one does not matter, what saturates in it takes it out.
  picture.at(9, 9) = 255;
  EXPECT_GT(ref::noise_q4(picture, picture), 84);
  picture.at(8, 8) = 255;
  EXPECT_EQ(ref::noise_q4(picture, picture), 0);
}

// At 1 1/2 levels 24 (24 - 16) / 20 = 9.6 counts, rounded down; all from 2 1/4 on.
TEST(Noise, GrowsFromNothing) {
  EXPECT_EQ(noise_of_bin_q4(19), 0);     // 312 makes 16.3
  EXPECT_EQ(noise_of_bin_q4(28), 9);     // 456: 23.8 counts as 24
  EXPECT_EQ(noise_of_bin_q4(43), 36);    // 696: 36.3
  EXPECT_EQ(noise_of_bin_q4(511), 256);  // 8184: 427.3
  for (int bin = 1; bin < kNoiseBins; ++bin) EXPECT_GE(noise_of_bin_q4(bin), noise_of_bin_q4(bin - 1)) << bin;
}

TEST(Noise, MeasuresWhiteNoise) {
  for (const double sigma : {3.0, 5.0, 8.0}) {
    const auto picture = noisy({320, 240}, sigma, 3, 7);
    const double found = ref::noise_q4(picture, picture) / 16.0;
    EXPECT_GT(found, 0.65 * sigma) << sigma;  // a low quantile lies below the mean
    EXPECT_LT(found, sigma) << sigma;
  }
  const auto clean = noisy({320, 240}, 0, 3, 7);
  EXPECT_EQ(ref::noise_q4(clean, clean), 0);
}

// What the raw picture does not cover is black, and says nothing.
TEST(Noise, FlatPartsDoNotCount) {
  auto picture = noisy({320, 240}, 4, 0, 3);
  const int all = ref::noise_q4(picture, picture);
  for (int y = 0; y < 120; ++y)
    for (int x = 0; x < 320; ++x) picture.at(y, x) = 0;
  EXPECT_NEAR(ref::noise_q4(picture, picture), all, 3);
}

TEST(Noise, SimdAgrees) {
  std::mt19937 rng(5);
  std::vector<Size> sizes = test::awkward_sizes();
  sizes.insert(sizes.end(), {{9, 40}, {10, 10}, {17, 25}, {18, 26}, {265, 26}, {266, 41}, {267, 42}, {600, 58}});
  for (const int threads : {1, 3}) {
    Pool pool(threads);
    for (const Size size : sizes)
      for (const test::Fill how : test::kFills) {
        test::Tight<std::uint8_t> left(size), right(size);
        test::fill(left.view, how, rng);
        test::fill(right.view, test::Fill::kLow, rng);
        EXPECT_EQ(simd::noise_q4(pool, left.view, right.view), ref::noise_q4(left.view, right.view))
            << size.width << "x" << size.height;
      }
    const auto left = noisy({640, 480}, 2, 1, 1), right = noisy({640, 480}, 1.5, 1, 2);
    EXPECT_EQ(simd::noise_q4(pool, left, right), ref::noise_q4(left, right));
    EXPECT_GT(ref::noise_q4(left, right), 0);
  }
}

}  // namespace
}  // namespace duo
