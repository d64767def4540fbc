#include "stages/conv_first16/conv_first16.h"

#include <vector>

#include "tests/agree.h"

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

}  // namespace
}  // namespace duo
