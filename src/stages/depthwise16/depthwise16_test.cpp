#include "stages/depthwise16/depthwise16.h"

#include <vector>

#include "tests/layers16.h"

namespace duo {
namespace {

// Two channels: the first has the weights 1 .. 9, the second the middle one alone.
struct TwoChannels {
  std::vector<std::int16_t> weights = std::vector<std::int16_t>(18), x = std::vector<std::int16_t>(32);
  std::vector<std::int32_t> bias = {0, 4};
  std::vector<std::uint8_t> shift = {0, 3};
  TwoChannels() {
    for (int i = 0; i < 9; ++i) weights[2 * i] = static_cast<std::int16_t>(i + 1);
    weights[2 * 4 + 1] = 8;
    for (int i = 0; i < 16; ++i) x[2 * i] = x[2 * i + 1] = static_cast<std::int16_t>(i);  // rows 0 1 2 3, 4 5 6 7, ...
  }
  Depthwise16 layer(int stride, int pad) const { return {2, 3, stride, pad, pad, weights, bias, shift, {}}; }
};

// By hand: top left with a border: 5*0 + 6*1 + 8*4 + 9*5 = 83; (1, 1): 1*0+2*1+3*2 + 4*4+5*5+6*6 + 7*8+8*9+9*10 = 303.
// The second channel: (8 * 6 + 4) >> 3 = 6 at (1, 2).
TEST(Depthwise16, HandWorked) {
  const TwoChannels made;
  std::vector<std::int16_t> y(32);
  const Tensor16 out{y.data(), {4, 4}, 2};
  ref::depthwise16(made.layer(1, 1), {made.x.data(), {4, 4}, 2}, out);
  EXPECT_EQ(out.pixel(0, 0)[0], 83);
  EXPECT_EQ(out.pixel(1, 1)[0], 303);
  EXPECT_EQ(out.pixel(1, 2)[1], 6);
}

// By hand, stride 2: without a border before the first, (0, 0) is what (1, 1) was above, and (1, 1) lies at (3, 3):
// 1*10+2*11 + 4*14+5*15 = 163; with a border (1, 1) of the result is again that around (2, 2).
TEST(Depthwise16, StrideTwoAndBothBorders) {
  const TwoChannels made;
  std::vector<std::int16_t> y(8);
  const Tensor16 out{y.data(), {2, 2}, 2};
  ref::depthwise16(made.layer(2, 0), {made.x.data(), {4, 4}, 2}, out);
  EXPECT_EQ(out.pixel(0, 0)[0], 303);
  EXPECT_EQ(out.pixel(1, 1)[0], 163);
  ref::depthwise16(made.layer(2, 1), {made.x.data(), {4, 4}, 2}, out);
  EXPECT_EQ(out.pixel(0, 0)[0], 83);
  EXPECT_EQ(out.pixel(1, 1)[1], 10);
}

// By hand: two weights of full size at values of full size fit, three do not.
TEST(Depthwise16, SumsFit) {
  std::vector<std::int16_t> w(9);
  const std::int32_t bias[] = {0};
  const std::uint8_t shift[] = {0};
  w[0] = w[8] = 32767;
  EXPECT_TRUE(sums_fit(Depthwise16{1, 3, 1, 1, 1, w, bias, shift, {}}, {}));
  w[4] = -32767;
  EXPECT_FALSE(sums_fit(Depthwise16{1, 3, 1, 1, 1, w, bias, shift, {}}, {}));
  EXPECT_TRUE(sums_fit(Depthwise16{1, 3, 1, 1, 1, w, bias, shift, {}}, {0, 32767}));
}

TEST(Depthwise16, SimdAgrees) {
  std::mt19937 rng(1);
  for (const int window : {3, 5})
    for (const int stride : {1, 2})
      for (const int channels : {1, 8, 13, 24, 40, 72})
        for (const Size size : {Size{1, 1}, Size{2, 2}, Size{4, 3}, Size{5, 6}, Size{9, 8}, Size{16, 11}}) {
          const int pad_top = static_cast<int>(rng() % window), pad_left = static_cast<int>(rng() % window);
          const test::RandomDepthwise16 random(channels, window, stride, pad_top, pad_left, rng);
          ASSERT_TRUE(sums_fit(random.layer, {}));
          const test::Made16 x(size, channels, rng);
          const Size out{(size.width + stride - 1) / stride, (size.height + stride - 1) / stride};
          test::agree16(
              "depthwise16 window " + std::to_string(window) + " stride " + std::to_string(stride), out, channels,
              [&](Tensor16 y) { ref::depthwise16(random.layer, x.view, y); },
              [&](Pool& pool, Tensor16 y) { simd::depthwise16(pool, random.layer, x.view, y); });
          if (HasFailure()) return;
        }
}

// Large enough for the threads to share bands of rows, or groups of channels where there are few rows.
TEST(Depthwise16, SimdAgreesInParts) {
  std::mt19937 rng(2);
  for (const Size size : {Size{43, 31}, Size{7, 7}}) {
    const test::RandomDepthwise16 random(120, 5, 1, 2, 2, rng);
    const test::Made16 x(size, 120, rng);
    test::agree16(
        "depthwise16", size, 120, [&](Tensor16 y) { ref::depthwise16(random.layer, x.view, y); },
        [&](Pool& pool, Tensor16 y) { simd::depthwise16(pool, random.layer, x.view, y); });
  }
}

}  // namespace
}  // namespace duo
