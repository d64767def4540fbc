#include "stages/resize2x16/resize2x16.h"

#include <vector>

#include "tests/layers16.h"

namespace duo {
namespace {

// By hand, of 0 16 over 32 48: the corner is itself; beside it (3 * 0 + 16) / 4 = 4; inside (9*0 + 3*16 + 3*32 + 48) / 16 = 12;
// a second channel of -1 everywhere stays -1.
TEST(Resize2x16, HandWorked) {
  const std::int16_t x[] = {0, -1, 16, -1, 32, -1, 48, -1};
  std::vector<std::int16_t> data(32);
  const Tensor16 y{data.data(), {4, 4}, 2};
  ref::resize2x16({x, {2, 2}, 2}, y);
  EXPECT_EQ(y.pixel(0, 0)[0], 0);
  EXPECT_EQ(y.pixel(0, 1)[0], 4);
  EXPECT_EQ(y.pixel(1, 1)[0], 12);
  EXPECT_EQ(y.pixel(3, 2)[0], 44);
  EXPECT_EQ(y.pixel(3, 3)[0], 48);
  for (int p = 0; p < 16; ++p) EXPECT_EQ(y.pixel(p)[1], -1);
}

TEST(Resize2x16, SimdAgrees) {
  std::mt19937 rng(1);
  for (const int channels : {1, 8, 15, 48, 77})
    for (const Size size : {Size{1, 1}, Size{2, 3}, Size{9, 4}, Size{40, 21}}) {
      const test::Made16 x(size, channels, rng);
      test::agree16(
          "resize2x16", {2 * size.width, 2 * size.height}, channels, [&](Tensor16 y) { ref::resize2x16(x.view, y); },
          [&](Pool& pool, Tensor16 y) { simd::resize2x16(pool, x.view, y); });
      if (HasFailure()) return;
    }
}

}  // namespace
}  // namespace duo
