#include "stages/maxpool2x16/maxpool2x16.h"

#include "tests/agree.h"

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

}  // namespace
}  // namespace duo
