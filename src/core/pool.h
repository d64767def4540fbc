// Pool: long-lived threads that share the rows of an image. Long waits block, nothing is allocated per call.
#pragma once

#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <mutex>
#include <thread>
#include <type_traits>
#include <utility>
#include <vector>

namespace duo {

/// Runs one job at a time on `threads` threads, the caller being one of them; on fewer where the system allows no more.
///
/// Threads  one caller at a time
class Pool {
 public:
  explicit Pool(int threads);
  ~Pool();
  Pool(const Pool&) = delete;
  Pool& operator=(const Pool&) = delete;

  /// Threads in use, and threads that exist.
  int threads() const { return in_use_; }
  int most() const { return static_cast<int>(workers_.size()) + 1; }
  /// Uses this many threads, 1 .. most(), until called again. Jobs are split into fewer parts then, never more.
  void use(int threads);

  /// Wall time of all jobs since the last call, and CPU time of all threads together in them.
  struct Effort {
    std::int64_t wall_ns = 0, cpu_ns = 0;
  };
  Effort take_effort();

  /// Calls f(begin, end) or f(begin, end, part) on contiguous parts of [0, count), one part a thread, each part's start a
  /// multiple of `grain`. Which thread runs which part must not change the result: stages write only their own rows; `part` <
  /// threads() chooses scratch memory.
  template <class F>
  void rows(int count, F&& f, int grain = 1) {
    auto call = [](void* context, int begin, int end, [[maybe_unused]] int part) {
      auto& work = *static_cast<std::remove_reference_t<F>*>(context);
      if constexpr (std::is_invocable_v<F, int, int, int>)
        work(begin, end, part);
      else
        work(begin, end);
    };
    run(count, grain, call, const_cast<void*>(static_cast<const void*>(&f)));
  }

  /// Calls f() on all threads in use at once. Within f, each `rows` and each `meet` is called by all of these threads, in the
  /// same order: `rows` runs the thread's own part and returns, `meet` returns when all threads have called it. Jobs of equal
  /// counts and grains have equal parts. What f does outside of `rows`, every thread does. For jobs of microseconds that follow
  /// each other, as the layers of a network: to wait for each other costs such threads 1 us, to wake them 5 to 50.
  template <class F>
  void together(F&& f) {
    const auto each = [&](int, int, int part) {
      const Member member(*this, part);
      f();
    };
    if (in_use_ == 1) return f();
    arrived_ = 0;
    rows(in_use_, each);
  }
  /// Outside of `together`, and where the caller is the only thread, it does nothing.
  void meet();

 private:
  using Call = void (*)(void* context, int begin, int end, int part);
  struct Job {
    int count = 0, grain = 1;
    Call call = nullptr;
    void* context = nullptr;
    /// Items of one of `parts` parts.
    std::pair<int, int> items(int part, int parts) const;
  };
  /// The calling thread is a member of what runs together, while this lives.
  class Member {
   public:
    Member(Pool& pool, int part);
    ~Member();
    Member(const Member&) = delete;
    Member& operator=(const Member&) = delete;
  };
  void run(int count, int grain, Call call, void* context);
  void run_part(int part);
  void compute(int begin, int end, int part);
  void work(int part);

  std::mutex mutex_;
  std::condition_variable start_, done_;
  std::atomic<std::uint64_t> round_ = 0;  // written under the mutex, as all that follows
  std::atomic<int> busy_ = 0;             // threads that have not ended this round
  std::atomic<int> arrived_ = 0;          // members that have come to a meeting, over all meetings of what runs together
  int in_use_ = 1;                        // the caller's
  int parts_ = 1;                         // of this round
  bool stop_ = false;
  Job job_;
  std::int64_t wall_ns_ = 0;
  std::atomic<std::int64_t> cpu_ns_ = 0;
  std::vector<std::jthread> workers_;  // last member: its threads use all others
};

}  // namespace duo
