#include "stages/matmul16/matmul16.h"

#include <vector>

#include "tests/layers16.h"

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

// By hand: 17 outputs of 4 inputs are two blocks of 2 + 2 rows of 16 words; output 16 is the second block's first.
TEST(Matmul16, Packs) {
  std::vector<std::int16_t> w(17 * 4);
  w[4 * 3] = -2, w[4 * 3 + 1] = 5, w[4 * 16 + 2] = 7;
  std::vector<std::int32_t> bias(17);
  bias[3] = 30;
  std::vector<std::uint8_t> shift(17);
  shift[16] = 9;
  const Matmul16 layer{4, 17, w, bias, shift, 0, {}};
  ASSERT_EQ(packed_words(layer), 2u * 4 * 16);
  std::vector<std::int32_t> packed(packed_words(layer), -1);
  pack(layer, packed);
  EXPECT_EQ(packed[3], 30);
  EXPECT_EQ(packed[2 * 16 + 3], 0x5FFFE);
  EXPECT_EQ(packed[64 + 16], 9);
  EXPECT_EQ(packed[64 + 3 * 16], 7);
  EXPECT_EQ(packed[64 + 3 * 16 + 1], 0) << "what the block lacks";
}

TEST(Matmul16, SimdAgrees) {
  std::mt19937 rng(1);
  for (const int inputs : {2, 24, 126, 128, 130, 386})
    for (const int outputs : {1, 7, 8, 15, 16, 17, 33, 56, 195}) {
      const test::RandomMatmul16 random(inputs, outputs, rng);
      ASSERT_TRUE(sums_fit(random.layer, {}));
      for (const int pixels : {1, 2, 3, 7, 8, 13, 67}) {
        const test::Made16 x({pixels, 1}, inputs, rng);
        test::agree16(
            "matmul16 of " + std::to_string(inputs), {pixels, 1}, outputs,
            [&](Tensor16 y) { ref::matmul16(random.layer, x.view, y); },
            [&](Pool& pool, Tensor16 y) { simd::matmul16(pool, random.layer, x.view, y); });
        if (HasFailure()) return;
      }
    }
}

// Large enough for the threads to share pixels, or outputs where there are few pixels.
TEST(Matmul16, SimdAgreesInParts) {
  std::mt19937 rng(2);
  for (const int pixels : {4, 333}) {
    const test::RandomMatmul16 random(512, 300, rng);
    const test::Made16 x({pixels, 1}, 512, rng);
    test::agree16(
        "matmul16", {pixels, 1}, 300, [&](Tensor16 y) { ref::matmul16(random.layer, x.view, y); },
        [&](Pool& pool, Tensor16 y) { simd::matmul16(pool, random.layer, x.view, y); });
  }
}

}  // namespace
}  // namespace duo
