// Objects come back by themselves, outlive their pool, and cost no memory while one is free.
#include "core/object_pool.h"

#include <gtest/gtest.h>

#include <thread>

#include "tests/allocations.h"

namespace duo {
namespace {

TEST(ObjectPool, LendsWhatIsFreeAndMakesMoreOnlyWhenAllAreLent) {
  int made = 0;
  ObjectPool<std::vector<int>> pool(2, [&] { return std::vector<int>{made++}; });
  EXPECT_EQ(made, 2);
  auto first = pool.lend(), second = pool.lend();
  EXPECT_NE(first, second);
  EXPECT_EQ(made, 2);
  const auto third = pool.lend();
  EXPECT_EQ(made, 3);
  EXPECT_EQ(third->front(), 2);
  const std::vector<int>* place = second.get();
  second->push_back(7);
  second.reset();
  const auto again = pool.lend();
  EXPECT_EQ(again.get(), place);
  EXPECT_EQ(again->back(), 7) << "as it was left";
  EXPECT_EQ(made, 3);
  EXPECT_EQ(pool.size(), 3U);
}

TEST(ObjectPool, AllocatesNothingWhileOneIsFree) {
  ObjectPool<int> pool(2, [] { return 0; });
  const long before = test::allocations;
  for (int i = 0; i < 100; ++i) {
    const std::shared_ptr<const int> one = pool.lend();
    const std::shared_ptr<const int> other = pool.lend(), part(one, one.get());
    const std::weak_ptr<const int> watched = other;
  }
  EXPECT_EQ(test::allocations - before, 0);
}

TEST(ObjectPool, AnObjectOutlivesItsPool) {
  std::shared_ptr<std::vector<int>> kept;
  {
    ObjectPool<std::vector<int>> pool(1, [] { return std::vector<int>{1, 2, 3}; });
    kept = pool.lend();
  }
  EXPECT_EQ(kept->back(), 3);
}

// What one thread wrote into an object is there for the thread that gets it next.
TEST(ObjectPool, ThreadsPassObjectsOn) {
  ObjectPool<int> pool(1, [] { return 0; });
  const auto work = [&] {
    for (int i = 0; i < 1000; ++i) ++*pool.lend();
  };
  { const std::jthread one(work), other(work); }
  int sum = 0;
  std::vector<std::shared_ptr<int>> all;
  for (std::size_t i = pool.size(); i > 0; --i) sum += *all.emplace_back(pool.lend());
  EXPECT_EQ(sum, 2000);
}

}  // namespace
}  // namespace duo
