#include "stages/depth_to_space16/depth_to_space16.h"

#include <vector>

#include "tests/layers16.h"

namespace duo {
namespace {

// By hand: two pixels of eight channels become two rows of four pixels of two.
TEST(DepthToSpace16, HandWorked) {
  std::vector<std::int16_t> x(16), data(16);
  for (int i = 0; i < 16; ++i) x[i] = static_cast<std::int16_t>(i);
  ref::depth_to_space16({x.data(), {2, 1}, 8}, {data.data(), {4, 2}, 2});
  EXPECT_EQ(data, (std::vector<std::int16_t>{0, 1, 2, 3, 8, 9, 10, 11, 4, 5, 6, 7, 12, 13, 14, 15}));
}

TEST(DepthToSpace16, SimdAgrees) {
  std::mt19937 rng(1);
  for (const int channels : {1, 6, 24})
    for (const Size size : {Size{1, 1}, Size{3, 2}, Size{70, 31}}) {
      const test::Made16 x(size, 4 * channels, rng);
      test::agree16(
          "depth_to_space16", {2 * size.width, 2 * size.height}, channels,
          [&](Tensor16 y) { ref::depth_to_space16(x.view, y); },
          [&](Pool& pool, Tensor16 y) { simd::depth_to_space16(pool, x.view, y); });
    }
}

}  // namespace
}  // namespace duo
