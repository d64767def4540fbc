// Order statistics by hand.
#include "duoptic/statistics.h"

#include <gtest/gtest.h>

#include <vector>

namespace duo {
namespace {

TEST(Statistics, EachIsOneOfTheValues) {
  EXPECT_EQ(nth(std::vector{4, 1, 3, 2}, 0), 1);
  EXPECT_EQ(median(std::vector{4, 1, 3, 2}), 3);  // the upper of the two in the middle
  EXPECT_EQ(median(std::vector{5, 1, 3}), 3);
  EXPECT_EQ(quantile(std::vector{7}, 0.95), 7);
  EXPECT_EQ(quantile(std::vector{4, 1, 3, 2}, 0.5), 2);      // index floor(1.5)
  EXPECT_EQ(quantile(std::vector{5, 4, 3, 2, 1}, 0.95), 4);  // index floor(3.8)
}

}  // namespace
}  // namespace duo
