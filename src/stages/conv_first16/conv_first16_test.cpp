#include "stages/conv_first16/conv_first16.h"

#include <vector>

#include "tests/layers16.h"

namespace duo {
namespace {

// By hand, a picture of 2 x 2 with red 1 2 3 4 and green 10: all weights of red 1, of green 0 but the middle's 2, of blue 0.
// With a border before: all red lies in the window, 10, and the middle is at (0, 0): 10 + 20 = 30, (30 + 2) >> 2 = 8.
// Without: the same red, and the middle is at (1, 1).
TEST(ConvFirst16, HandWorked) {
  std::vector<std::int16_t> w(27);
  for (int i = 0; i < 9; ++i) w[3 * i] = 1;
  w[3 * 4 + 1] = 2;
  const std::int32_t bias[] = {2};
  const std::uint8_t shift[] = {2};
  const std::int16_t x[] = {1, 10, 5, 2, 0, 5, 3, 0, 5, 4, 100, 5};
  std::int16_t y = 0;
  ref::conv_first16({1, 1, 1, w, bias, shift, {}}, {x, {2, 2}, 3}, {&y, {1, 1}, 1});
  EXPECT_EQ(y, 8);
  ref::conv_first16({1, 0, 0, w, bias, shift, {}}, {x, {2, 2}, 3}, {&y, {1, 1}, 1});
  EXPECT_EQ(y, 53) << "(10 + 200 + 2) >> 2";
  ref::conv_first16({1, 0, 0, w, bias, shift, {0, 50}}, {x, {2, 2}, 3}, {&y, {1, 1}, 1});
  EXPECT_EQ(y, 50);
}

TEST(ConvFirst16, SumsFit) {
  std::vector<std::int16_t> w(27);
  const std::int32_t bias[] = {0};
  const std::uint8_t shift[] = {0};
  w[0] = w[26] = 32767;
  EXPECT_TRUE(sums_fit(ConvFirst16{1, 1, 1, w, bias, shift, {}}, {}));
  w[13] = 5;
  EXPECT_FALSE(sums_fit(ConvFirst16{1, 1, 1, w, bias, shift, {}}, {}));
}

// By hand: 17 outputs are two blocks of 2 + 15 rows of 16 words; of a row of 9 weights the last has 0 beside it.
TEST(ConvFirst16, Packs) {
  std::vector<std::int16_t> w(17 * 27);
  w[27 * 16 + 9] = -3, w[27 * 16 + 10] = 4, w[27 * 16 + 17] = 6;
  std::vector<std::int32_t> bias(17);
  bias[16] = 11;
  const std::vector<std::uint8_t> shift(17, 5);
  const ConvFirst16 layer{17, 1, 1, w, bias, shift, {}};
  ASSERT_EQ(packed_words(layer), 2u * 17 * 16);
  std::vector<std::int32_t> packed(packed_words(layer), -1);
  pack(layer, packed);
  EXPECT_EQ(packed[17 * 16], 11);
  EXPECT_EQ(packed[17 * 16 + 16], 5);
  EXPECT_EQ(packed[17 * 16 + (2 + 5) * 16], 0x4FFFD);
  EXPECT_EQ(packed[17 * 16 + (2 + 9) * 16], 6);
  EXPECT_EQ(packed[17 * 16 + 1], 0) << "what the block lacks";
}

TEST(ConvFirst16, SimdAgrees) {
  std::mt19937 rng(1);
  for (const int outputs : {1, 8, 15, 16, 24, 33})
    for (const int pad_top : {0, 1})
      for (const int pad_left : {0, 1})
        for (const Size size : {Size{2, 2}, Size{4, 6}, Size{18, 4}, Size{40, 10}, Size{66, 12}}) {
          const test::RandomConvFirst16 random(outputs, pad_top, pad_left, rng);
          ASSERT_TRUE(sums_fit(random.layer, {}));
          const test::Made16 x(size, 3, rng);
          test::agree16(
              "conv_first16", {size.width / 2, size.height / 2}, outputs,
              [&](Tensor16 y) { ref::conv_first16(random.layer, x.view, y); },
              [&](Pool& pool, Tensor16 y) { simd::conv_first16(pool, random.layer, x.view, y); });
          if (HasFailure()) return;
        }
}

}  // namespace
}  // namespace duo
