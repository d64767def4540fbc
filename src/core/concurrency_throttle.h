// Chooses how many threads of a pool to use while other programs load the CPU.
#pragma once

#include <algorithm>
#include <cstdint>

namespace duo {

/// Threads that share a frame wait for each other at every stage. While other programs take their cores, most of a frame is
/// waiting, and fewer threads are faster. When frames take twice as long as they would without waiting, half of the threads are
/// tried for some frames and kept if the frames get faster. Later more threads are tried again; each try that does not pay
/// doubles the time to the next one.
///
/// Source  concurrency throttling by measured times (Curtis-Maury, Dzierwa, Antonopoulos, Nikolopoulos, "Online
/// power-performance
///         adaptation of multithreaded programs using hardware event-based prediction", 2006); the rule is ours
class ConcurrencyThrottle {
 public:
  explicit ConcurrencyThrottle(int threads) : all_(threads), now_(threads) {}

  /// Of the next frame.
  int threads() const { return now_; }

  /// Reports a frame: the wall time it took with threads() threads, and the CPU time of all of them together.
  void made(std::int64_t wall_ns, std::int64_t cpu_ns) {
    if (all_ == 1 || wall_ns <= 0 || cpu_ns <= 0) return;
    const double wall = static_cast<double>(wall_ns), waiting = wall * now_ / static_cast<double>(cpu_ns);
    if (tried_ > 0) return judge(wall, waiting);
    wall_ += (wall - wall_) / (wall_ > 0 ? kSmooth : 1);
    waiting_ += (std::min(waiting, 1.5 * most_waiting_) - waiting_) /
                kSmooth;  // clamped: one long stall cannot cause a change by itself
    rest_ -= waiting < kQuiet ? kSooner : 1;
    if (now_ > 1 && waiting_ > most_waiting_)
      try_out(now_ / 2);
    else if (now_ < all_ && rest_ <= 0)
      try_out(std::min(all_, 2 * now_));
  }

 private:
  static constexpr double kSmooth = 8;       // frames: a short load of other programs is no reason to change
  static constexpr double kMostWaiting = 2;  // wall time over wall time without waiting
  static constexpr double kQuiet = 1.1;      // the same while no other program loads the CPU
  static constexpr int kTried = 3, kSooner = 4, kFirstRest = 16, kLongestRest = 256;  // frames

  void try_out(int threads) {
    before_ = now_;
    now_ = threads;
    tried_ = kTried;
    tried_wall_ = tried_waiting_ = 0;
  }

  void judge(double wall, double waiting) {
    tried_wall_ += wall;
    tried_waiting_ += waiting;
    const bool more = now_ > before_;
    if (tried_wall_ >= kTried * wall_) {  // no faster
      if (more)
        next_rest_ = std::min(2 * next_rest_, kLongestRest);
      else
        most_waiting_ = std::max(kMostWaiting, 1.5 * waiting_);  // waiting that fewer threads do not cure
      now_ = before_;
      tried_ = 0;
      rest_ = next_rest_;
    } else if (--tried_ == 0) {
      if (more) next_rest_ = kFirstRest;
      most_waiting_ = more ? std::max(kMostWaiting, 1.5 * tried_waiting_ / kTried) : kMostWaiting;
      wall_ = tried_wall_ / kTried;
      waiting_ = 1;
      rest_ = next_rest_;
    }
  }

  int all_, now_, before_ = 1;
  double wall_ = 0, waiting_ = 1, most_waiting_ = kMostWaiting;  // of frames with now_ threads, lately
  int rest_ = kFirstRest, next_rest_ = kFirstRest;               // frames until more threads are tried
  int tried_ = 0;                                                // frames that now_ threads are still tried
  double tried_wall_ = 0, tried_waiting_ = 0;
};

}  // namespace duo
