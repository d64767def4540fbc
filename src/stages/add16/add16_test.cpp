#include "stages/add16/add16.h"

#include "tests/layers16.h"

namespace duo {
namespace {

// By hand: (5 * 4 + 3 + 1) >> 1 = 12; (-5 * 4 + 2 + 1) >> 1 = -9 (-8.5 goes down); a channel that b lacks: (7 * 4 + 1) >> 1
// = 14.
TEST(Add16, HandWorked) {
  const std::int16_t a[] = {5, -5, 7}, b[] = {3, 2};
  std::int16_t y[3];
  ref::add16({2, 0, 1, {}}, {a, {1, 1}, 3}, {b, {1, 1}, 2}, {y, {1, 1}, 3});
  EXPECT_EQ(y[0], 12);
  EXPECT_EQ(y[1], -9);
  EXPECT_EQ(y[2], 14);
  ref::add16({2, 0, 1, {0, 13}}, {a, {1, 1}, 3}, {b, {1, 1}, 2}, {y, {1, 1}, 3});
  EXPECT_EQ(y[1], 0);
  EXPECT_EQ(y[2], 13);
}

// By hand: the largest of both, 2 * 32767 * 2^14 = 1073709056, and shifted back by 15.
TEST(Add16, LargestValues) {
  const std::int16_t a[] = {32767, -32767};
  std::int16_t y[2];
  ref::add16({14, 14, 15, {}}, {a, {1, 1}, 2}, {a, {1, 1}, 2}, {y, {1, 1}, 2});
  EXPECT_EQ(y[0], 32767);
  EXPECT_EQ(y[1], -32767);
  ref::add16({0, 0, 0, {}}, {a, {1, 1}, 2}, {a, {1, 1}, 2}, {y, {1, 1}, 2});
  EXPECT_EQ(y[0], 32767) << "clamped";
}

TEST(Add16, SimdAgrees) {
  std::mt19937 rng(1);
  for (const int channels : {1, 7, 8, 24, 45, 130})
    for (const int of_b : {channels, (channels + 1) / 2})
      for (const Size size : {Size{1, 1}, Size{3, 2}, Size{17, 5}, Size{64, 40}}) {
        const Add16 layer{static_cast<int>(rng() % 15), static_cast<int>(rng() % 15), static_cast<int>(rng() % 16),
                          test::range16(rng)};
        const test::Made16 a(size, channels, rng), b(size, of_b, rng);
        test::agree16(
            "add16", size, channels, [&](Tensor16 y) { ref::add16(layer, a.view, b.view, y); },
            [&](Pool& pool, Tensor16 y) {
              std::copy(a.data.begin(), a.data.end(), y.data());  // y may be a
              simd::add16(pool, layer, y, b.view, y);
            });
        if (HasFailure()) return;
      }
}

}  // namespace
}  // namespace duo
