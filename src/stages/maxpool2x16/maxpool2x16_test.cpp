#include "stages/maxpool2x16/maxpool2x16.h"

#include "tests/layers16.h"

namespace duo {
namespace {

TEST(Maxpool2x16, HandWorked) {
  const std::int16_t x[] = {1, -9, 2, -8, 5, 0, 6, 0,    //
                            3, -7, 4, -6, 8, 0, 7, -1};  // 2 x 4 pixels of two channels
  std::int16_t y[4];
  ref::maxpool2x16({x, {4, 2}, 2}, {y, {2, 1}, 2});
  EXPECT_EQ(y[0], 4);
  EXPECT_EQ(y[1], -6);
  EXPECT_EQ(y[2], 8);
  EXPECT_EQ(y[3], 0);
}

TEST(Maxpool2x16, SimdAgrees) {
  std::mt19937 rng(1);
  for (const int channels : {1, 8, 15, 48, 77})
    for (const Size size : {Size{1, 1}, Size{2, 3}, Size{9, 4}, Size{60, 21}}) {
      const test::Made16 x({2 * size.width, 2 * size.height}, channels, rng);
      test::agree16(
          "maxpool2x16", size, channels, [&](Tensor16 y) { ref::maxpool2x16(x.view, y); },
          [&](Pool& pool, Tensor16 y) { simd::maxpool2x16(pool, x.view, y); });
      if (HasFailure()) return;
    }
}

}  // namespace
}  // namespace duo
