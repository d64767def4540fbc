#include "stages/matmul16/matmul16.h"

#include <vector>

#include "tests/agree.h"

namespace duo {
namespace {

// By hand: 3*10 + -2*4 = 22 -> (22 + 2) >> 2 = 6; 3*-1 + -2*0 = -3 -> (-3 + 1 + 0) >> 1 = -1.
TEST(Matmul16, HandWorked) {
  const std::int16_t w[] = {10, 4, -1, 0};
  const std::int32_t bias[] = {2, 1};
  const std::uint8_t shift[] = {2, 1};
  const Matmul16 layer{2, 2, w, bias, shift, 0, {}};
  const std::int16_t x[] = {3, -2};
  std::int16_t y[2];
  ref::matmul16(layer, {x, {1, 1}, 2}, {y, {1, 1}, 2});
  EXPECT_EQ(y[0], 6);
  EXPECT_EQ(y[1], -1);
}

// By hand: 130 inputs of 1: chunks of 128 and 2, (128 + 2) >> 2 = 32 and (2 + 2) >> 2 = 1; 33 + 100 = 133, clamped to 120.
TEST(Matmul16, FoldsEachChunkAndClamps) {
  const std::vector<std::int16_t> w(130, 1), x(130, 1);
  const std::int32_t bias[] = {100};
  const std::uint8_t shift[] = {0};
  Matmul16 layer{130, 1, w, bias, shift, 2, {}};
  std::int16_t y = 0;
  ref::matmul16(layer, {x.data(), {1, 1}, 130}, {&y, {1, 1}, 1});
  EXPECT_EQ(y, 133);
  layer.range = {0, 120};
  ref::matmul16(layer, {x.data(), {1, 1}, 130}, {&y, {1, 1}, 1});
  EXPECT_EQ(y, 120);
}

// By hand: 2 * 32767 * 32767 = 2147352578 is 131069 below 2^31 - 1; three are too many unless the values cannot be negative and
// the weights have both signs.
TEST(Matmul16, SumsFit) {
  const std::int16_t w[] = {32767, 32767, -32767};
  std::int32_t bias[] = {131069};
  const std::uint8_t shift[] = {0};
  EXPECT_TRUE(sums_fit({2, 1, {w, 2}, bias, shift, 0, {}}, {}));
  EXPECT_FALSE(sums_fit({3, 1, w, bias, shift, 0, {}}, {}));
  EXPECT_TRUE(sums_fit({3, 1, w, bias, shift, 0, {}}, {0, 32767}));
  bias[0] = 131070;
  EXPECT_FALSE(sums_fit({2, 1, {w, 2}, bias, shift, 0, {}}, {}));
}

}  // namespace
}  // namespace duo
