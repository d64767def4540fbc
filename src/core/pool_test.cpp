#include "core/concurrency_throttle.h"

#include <gtest/gtest.h>
#include <sys/resource.h>

#include <algorithm>
#include <atomic>
#include <cstdlib>
#include <thread>
#include <vector>

#include "core/pool.h"

namespace duo {
namespace {

constexpr std::int64_t kMs = 1'000'000;

/// Frames of 30 ms of arithmetic; `took(threads)`: how long each takes. Returns the threads of each.
template <class F>
std::vector<int> frames(ConcurrencyThrottle& throttle, int count, F took) {
  std::vector<int> out;
  for (int i = 0; i < count; ++i) {
    out.push_back(throttle.threads());
    throttle.made(took(throttle.threads()) * kMs, 30 * kMs);
  }
  return out;
}

TEST(ConcurrencyThrottle, KeepsAllThreadsThatHaveTheirCores) {
  ConcurrencyThrottle throttle(2);
  EXPECT_EQ(frames(throttle, 200, [](int threads) { return threads == 2 ? 18 : 30; }), std::vector(200, 2));
}

// A moment in which others have the cores: what rests comes back a while later, and would be missed until then.
TEST(ConcurrencyThrottle, ThreeSlowFramesChangeNothing) {
  ConcurrencyThrottle throttle(2);
  int i = 0;
  EXPECT_EQ(frames(throttle, 50, [&](int) { return ++i >= 20 && i < 23 ? 60 : 18; }), std::vector(50, 2));
}

TEST(ConcurrencyThrottle, OneThreadWhereTwoWaitForEachOther) {
  ConcurrencyThrottle throttle(2);
  const auto threads = frames(throttle, 1000, [](int n) { return n == 2 ? 150 : 50; });
  EXPECT_EQ(threads[9], 1);
  // Two are tried again less and less often: a frame each time, as that alone takes as long as three of one thread.
  EXPECT_LT(std::count(threads.begin() + 9, threads.end(), 2), 10);
  EXPECT_GT(std::count(threads.begin() + 9, threads.end(), 2), 2);
}

TEST(ConcurrencyThrottle, AllComeBackWhenTheCoresAreFree) {
  ConcurrencyThrottle throttle(2);
  frames(throttle, 500, [](int n) { return n == 2 ? 150 : 50; });
  // The one thread waits no longer: soon two are tried, and stay.
  const auto threads = frames(throttle, 80, [](int n) { return n == 2 ? 18 : 30; });
  EXPECT_EQ(threads.back(), 2);
}

TEST(ConcurrencyThrottle, HalfOfManyIsTriedFirst) {
  ConcurrencyThrottle throttle(16);
  // Four cores are free: the more threads, the longer it takes beyond them.
  const auto threads = frames(throttle, 400, [](int n) { return n <= 4 ? 32 / n : 8 * n / 4; });
  EXPECT_EQ(threads[0], 16);
  EXPECT_GT(std::count(threads.begin(), threads.end(), 4), 350);
}

TEST(ConcurrencyThrottle, ThreadsThatWaitByNatureStay) {
  ConcurrencyThrottle throttle(16);
  // Sixteen take as long as twice two would, and are the fastest all the same.
  const auto threads = frames(throttle, 400, [](int n) { return n == 16 ? 7 : n == 8 ? 9 : 30; });
  EXPECT_EQ(threads.back(), 16);
  EXPECT_LT(std::count(threads.begin() + 100, threads.end(), 8), 20);
}

TEST(Pool, UsesAsManyThreadsAsItIsTold) {
  Pool pool(3);
  for (const int threads : {3, 1, 2, 3}) {
    pool.use(threads);
    EXPECT_EQ(pool.threads(), threads);
    EXPECT_EQ(pool.most(), 3);
    std::atomic<int> parts = 0, rows = 0;
    pool.rows(1000, [&](int begin, int end, int part) {
      EXPECT_LT(part, threads);
      ++parts;
      rows += end - begin;
    });
    EXPECT_EQ(parts, threads);
    EXPECT_EQ(rows, 1000);
  }
}

// A thread that wakes late, for work it had no part in, must not take part when more are in use by then.
TEST(Pool, ThreadsThatRestedDoNotWorkTwice) {
  Pool pool(4);
  for (int i = 0; i < 20000; ++i) {
    pool.use(i % 2 == 0 ? 2 : 4);
    std::atomic<int> rows = 0;
    pool.rows(64, [&](int begin, int end) { rows += end - begin; });
    ASSERT_EQ(rows, 64);
    pool.use(4);
    if (i % 7 == 0) std::this_thread::yield();
  }
}

// Each step reads what a neighbour's thread wrote before the last meeting; a job of one item is done by one thread.
TEST(Pool, StepsThatRunTogetherWaitForEachOther) {
  constexpr int kCount = 1000, kSteps = 500;
  for (const int threads : {1, 2, 5}) {
    Pool pool(threads);
    for (int again = 0; again < 3; ++again) {
      std::vector<int> even(kCount), odd(kCount);
      for (int i = 0; i < kCount; ++i) even[i] = i;
      int alone = 0;
      pool.together([&] {
        for (int step = 0; step < kSteps; ++step) {
          const std::vector<int>& before = step % 2 == 0 ? even : odd;
          std::vector<int>& after = step % 2 == 0 ? odd : even;
          pool.rows(kCount, [&](int begin, int end) {
            for (int i = begin; i < end; ++i) after[i] = before[(i + 1) % kCount] + 1;
          });
          pool.rows(1, [&](int, int) { ++alone; });
          pool.meet();
        }
      });
      for (int i = 0; i < kCount; ++i) ASSERT_EQ(even[i], (i + kSteps) % kCount + kSteps) << threads << " threads";
      EXPECT_EQ(alone, kSteps);
    }
  }
}

TEST(Pool, TellsWhatItsThreadsTook) {
  Pool pool(2);
  for (const int threads : {1, 2}) {
    pool.use(threads);
    pool.take_effort();
    pool.rows(2, [&](int begin, int end) {
      volatile int steps = 0;
      while (steps < (end - begin) * 10'000'000) steps = steps + 1;
    });
    const Pool::Effort effort = pool.take_effort();
    EXPECT_GT(effort.wall_ns, 0);
    EXPECT_GT(effort.cpu_ns, effort.wall_ns / 20);  // a busy machine may give it little
    EXPECT_LE(effort.cpu_ns, threads * effort.wall_ns + kMs);
    EXPECT_EQ(pool.take_effort().wall_ns, 0);
  }
}

#if defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer)
#define DUO_SANITIZED
#endif
#endif
#ifndef DUO_SANITIZED  // whose own memory is more than the limit
/// In a process of its own, whose memory has room for the stacks of a few threads.
[[noreturn]] void ask_for_too_many() {
  rlimit room = {};
  room.rlim_cur = room.rlim_max = std::size_t{1} << 28;
  setrlimit(RLIMIT_AS, &room);
  Pool pool(200);
  std::atomic<int> sum = 0;
  pool.rows(1000, [&](int begin, int end) { sum += end - begin; });
  std::_Exit(pool.threads() < 200 && pool.threads() == pool.most() && sum == 1000 ? 0 : 1);
}

TEST(Pool, DoesWithTheThreadsThatThereMayBe) { EXPECT_EXIT(ask_for_too_many(), testing::ExitedWithCode(0), ""); }
#endif

}  // namespace
}  // namespace duo
