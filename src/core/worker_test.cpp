// Hand-over between threads: each value in order, or the newest; ends, errors and exceptions arrive as results.
#include "duoptic/worker.h"

#include <gtest/gtest.h>
#include <sys/resource.h>

#include <atomic>
#include <stdexcept>
#include <vector>

#include "duoptic/bounded_queue.h"

namespace duo {
namespace {

using namespace std::chrono_literals;

TEST(BoundedQueue, EachValueInOrderThenTheEnd) {
  for (const std::size_t capacity : {1, 2, 7}) {
    constexpr int kValues = 2000;
    BoundedQueue<int> queue(capacity, WhenFull::kWait);
    auto worker = Worker::start(
        "count",
        [&](const std::stop_token&) -> Result<void> {
          for (int i = 0; i < kValues; ++i) {
            int value = i;
            if (!queue.put(value)) return Error{ErrorCode::kBadInput, "closed"};
          }
          return {};
        },
        [&](const Result<void>& result) { queue.close(result); });
    ASSERT_TRUE(worker);
    int value = -1;
    for (int i = 0; i < kValues; ++i) {
      ASSERT_EQ(*queue.take(value), Taken::kValue);
      ASSERT_EQ(value, i);
    }
    EXPECT_EQ(*queue.take(value), Taken::kClosed);
    EXPECT_EQ(queue.dropped(), 0);
    EXPECT_TRUE(worker->join());
  }
}

TEST(BoundedQueue, TheOldestMakesRoomAndIsCounted) {
  BoundedQueue<int> newest(1, WhenFull::kDropOldest), last_three(3, WhenFull::kDropOldest);
  for (int i = 0; i < 10; ++i) {
    int value = i;
    EXPECT_TRUE(newest.put(value));
    value = i;
    EXPECT_TRUE(last_three.put(value));
  }
  EXPECT_EQ(newest.dropped(), 9);
  EXPECT_EQ(last_three.dropped(), 7);
  int value = -1;
  EXPECT_EQ(*newest.take(value), Taken::kValue);
  EXPECT_EQ(value, 9);
  EXPECT_EQ(*newest.take(value, 1ms), Taken::kNothing);
  for (int i = 7; i < 10; ++i) {
    EXPECT_EQ(*last_three.take(value), Taken::kValue);
    EXPECT_EQ(value, i);
  }
}

// A vector that was taken comes back to who puts the next one.
TEST(BoundedQueue, MemoryGoesAround) {
  BoundedQueue<std::vector<int>> queue(1, WhenFull::kWait);
  std::vector<int> mine(100, 1), theirs(50, 2);
  const int *first = mine.data(), *second = theirs.data();
  EXPECT_TRUE(queue.put(mine));
  EXPECT_TRUE(mine.empty());
  EXPECT_EQ(*queue.take(theirs), Taken::kValue);
  EXPECT_EQ(theirs.data(), first);
  EXPECT_TRUE(queue.put(mine));
  EXPECT_EQ(mine.data(), second);
}

TEST(BoundedQueue, AnErrorComesAfterTheValuesBeforeIt) {
  BoundedQueue<int> queue(4, WhenFull::kWait);
  int value = 3;
  EXPECT_TRUE(queue.put(value));
  queue.close(Error{ErrorCode::kDeviceLost, "the camera is away"});
  queue.close();  // says nothing new
  EXPECT_FALSE(queue.put(value));
  EXPECT_EQ(*queue.take(value), Taken::kValue);
  EXPECT_EQ(value, 3);
  for (int i = 0; i < 2; ++i) {
    const auto taken = queue.take(value);
    ASSERT_FALSE(taken);
    EXPECT_EQ(taken.error().what, "the camera is away");
  }
}

// Who waits for room or for a value goes on when the other side has gone.
TEST(BoundedQueue, ClosingWakesBothSides) {
  BoundedQueue<int> full(1, WhenFull::kWait), empty(1, WhenFull::kWait);
  int value = 0;
  EXPECT_TRUE(full.put(value));
  std::atomic<int> woken = 0;
  auto putting = Worker::start("put", [&](const std::stop_token&) -> Result<void> {
    int another = 1;
    if (!full.put(another)) ++woken;
    return {};
  });
  auto taking = Worker::start("take", [&](const std::stop_token&) -> Result<void> {
    int taken = 0;
    if (*empty.take(taken) == Taken::kClosed) ++woken;
    return {};
  });
  ASSERT_TRUE(putting && taking);
  EXPECT_FALSE(putting->ends_within(5ms));
  EXPECT_FALSE(taking->ends_within(5ms));
  full.close();
  empty.close();
  EXPECT_TRUE(putting->join() && taking->join());
  EXPECT_EQ(woken, 2);
}

TEST(Worker, WhatIsThrownIsAnError) {
  const auto message_of = [](const std::function<void()>& thrower) {
    Result<void> told;
    auto worker = Worker::start(
        "read the next pair",
        [&](const std::stop_token&) -> Result<void> {
          thrower();
          return {};
        },
        [&](const Result<void>& result) { told = result; });
    EXPECT_TRUE(worker);
    const Result<void> result = worker->join();
    EXPECT_EQ(result.error().what, told.error().what);
    return result.error().what;
  };
  EXPECT_EQ(message_of([] { throw std::bad_alloc(); }), "cannot read the next pair: out of memory; smaller pictures need less");
  EXPECT_EQ(message_of([] { throw std::runtime_error("the moon is full"); }), "cannot read the next pair: the moon is full");
  EXPECT_NE(message_of([] { throw std::system_error(EAGAIN, std::generic_category()); }).find("unavailable"),
            std::string::npos);
}

TEST(Worker, TheDestructorAsksToStopAndWaits) {
  std::atomic<bool> stopped = false;
  {
    auto worker = Worker::start("wait", [&](const std::stop_token& stop) -> Result<void> {
      while (!stop.stop_requested()) std::this_thread::sleep_for(1ms);
      stopped = true;
      return {};
    });
    ASSERT_TRUE(worker);
    EXPECT_FALSE(worker->ends_within(2ms));
  }
  EXPECT_TRUE(stopped);
}

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)  // g++
#define DUO_SANITIZED
#elif defined(__has_feature)  // clang
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer)
#define DUO_SANITIZED
#endif
#endif

// A system without threads left: root has no such limit, so an address space that a thread's stack does not fit into stands for
// it.
TEST(Worker, ARefusedThreadIsAnError) {
#ifdef DUO_SANITIZED
  GTEST_SKIP() << "sanitizers need address space";
#endif
  rlimit before{};
  getrlimit(RLIMIT_AS, &before);
  const rlimit none{1 << 20, before.rlim_max};
  std::vector<Worker> workers;  // they use up the stacks of threads before
  workers.reserve(100);
  const auto wait = [](const std::stop_token& stop) -> Result<void> {
    while (!stop.stop_requested()) std::this_thread::sleep_for(1ms);
    return {};
  };
  if (setrlimit(RLIMIT_AS, &none) != 0) GTEST_SKIP() << "no limit can be set here";
  auto worker = Worker::start("read the next pair", wait);
  while (worker && workers.size() < 100) {
    workers.push_back(std::move(*worker));
    worker = Worker::start("read the next pair", wait);
  }
  setrlimit(RLIMIT_AS, &before);
  ASSERT_FALSE(worker);
  EXPECT_NE(worker.error().what.find("cannot start a thread to read the next pair: "), std::string::npos)
      << worker.error().what;
}

}  // namespace
}  // namespace duo
