#include "pipeline/cpu_budget.h"

#include <gtest/gtest.h>

namespace duo {
namespace {

constexpr std::int64_t kMs = 1'000'000;

/// Pairs each 10 ms for two seconds, of which each that is taken costs `cost_ms`: how many are taken.
int taken(CpuBudget& budget, std::int64_t cost_ms) {
  int out = 0;
  std::int64_t cpu_ns = 0;
  for (std::int64_t wall_ms = 0; wall_ms < 2000; wall_ms += 10)
    if (budget.allows(wall_ms * kMs, cpu_ns)) ++out, cpu_ns += cost_ms * kMs;
  return out;
}

TEST(CpuBudget, HoldsTheShare) {
  CpuBudget all(0), half(0.5), whole(1), two(2);
  EXPECT_EQ(taken(all, 20), 200);
  // 2 s of half a core: 1 s, 50 pairs of 20 ms.
  EXPECT_NEAR(taken(half, 20), 50, 1);
  EXPECT_NEAR(taken(whole, 20), 100, 1);
  EXPECT_EQ(taken(two, 20), 200);  // no more than there are
}

TEST(CpuBudget, APairPerSecondAtLeast) {
  CpuBudget little(0.001);
  EXPECT_EQ(taken(little, 400), 2);  // at 0 and 1 s
}

TEST(CpuBudget, RestIsSavedForATenthOfASecond) {
  CpuBudget half(0.5);
  EXPECT_TRUE(half.allows(0, 0));
  // 10 s of rest save 50 ms: two pairs of 30 ms that come at once, and then none.
  EXPECT_TRUE(half.allows(10'000 * kMs, 0));
  EXPECT_TRUE(half.allows(10'001 * kMs, 30 * kMs));
  EXPECT_FALSE(half.allows(10'002 * kMs, 60 * kMs));
  // Owed is 60 - 50 - 0.5 * 2 = 9 ms, and 18 ms pay for it.
  EXPECT_FALSE(half.allows(10'019 * kMs, 60 * kMs));
  EXPECT_TRUE(half.allows(10'020 * kMs, 60 * kMs));
}

}  // namespace
}  // namespace duo
