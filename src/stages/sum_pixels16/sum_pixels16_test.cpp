#include "stages/sum_pixels16/sum_pixels16.h"

#include "tests/agree.h"

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

}  // namespace
}  // namespace duo
