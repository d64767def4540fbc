#include "stages/sum_pixels16/sum_pixels16.h"

#include "tests/layers16.h"

namespace duo {
namespace {

// By hand: (10 + 20 + 32 + 2) >> 2 = 16 and (-1 - 2 - 2 + 2) >> 2 = -1.
TEST(SumPixels16, HandWorked) {
  const std::int16_t x[] = {10, -1, 20, -2, 32, -2};
  std::int16_t y[2];
  ref::sum_pixels16({x, {3, 1}, 2}, 2, {y, {1, 1}, 2});
  EXPECT_EQ(y[0], 16);
  EXPECT_EQ(y[1], -1);
}

TEST(SumPixels16, SimdAgrees) {
  std::mt19937 rng(1);
  for (const int channels : {1, 8, 15, 48, 77})
    for (const Size size : {Size{1, 1}, Size{2, 1}, Size{7, 7}, Size{128, 256}}) {
      const test::Made16 x(size, channels, rng);
      int shift = 0;
      while (1 << shift < x.view.pixels()) ++shift;
      test::agree16(
          "sum_pixels16", {1, 1}, channels, [&](Tensor16 y) { ref::sum_pixels16(x.view, shift, y); },
          [&](Pool& pool, Tensor16 y) { simd::sum_pixels16(pool, x.view, shift, y); });
    }
}

}  // namespace
}  // namespace duo
