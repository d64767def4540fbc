// Makes the next frame while the last one is worked on.
#pragma once

#include <array>
#include <condition_variable>
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <thread>
#include <utility>

#include "duoptic/engine.h"
#include "read_ahead.h"
#include "timing.h"

namespace duo::app {

/// A pair and the frame that an engine made of it.
struct Matched {
  Pair pair;
  const Frame* frame = nullptr;
  double engine_ms = 0;
};

/// Pairs through an engine, in a thread of their own, one frame ahead; reading has another thread, one pair ahead of that. The
/// same frames in the same order.
class FrameAhead {
 public:
  /// Pairs before number `first` are read, not matched, and not given. The engine must be prepared, and outlive this.
  FrameAhead(std::unique_ptr<PairSource> pairs, Engine& engine, std::int64_t first)
      : pairs_(std::move(pairs)), engine_(engine), first_(first), thread_([this] { match_all(); }) {}
  ~FrameAhead() {
    {
      const std::lock_guard lock(mutex_);
      stopped_ = true;
    }
    changed_.notify_all();
    thread_.join();
  }

  std::int64_t count() const { return pairs_.count(); }
  /// As PairSource::next(), into last(); not to be called again after the end or an error.
  Result<Next> next() {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [this] { return matched_.has_value(); });
    ahead_ ^= 1;
    Result<Next> next = *std::exchange(matched_, std::nullopt);
    lock.unlock();
    changed_.notify_all();
    return next;
  }
  /// Lives until the call after the next of next().
  const Matched& last() const { return slots_[ahead_ ^ 1U]; }
  /// Until the next frame is ready; then nothing goes on in the background.
  void wait() {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [this] { return matched_.has_value() || ended_; });
  }
  TimeNs start_ns() const { return start_ns_; }  // of the first pair, once next() gave one
  /// Pairs that were read before the end, and what PairSource::warning() says then.
  std::int64_t read() const { return read_; }
  std::string warning() const { return pairs_.warning(); }

 private:
  void match_all() {
    for (bool more = true; more;) {
      Result<Next> next = match();
      more = next && *next == Next::kPicture;
      std::unique_lock lock(mutex_);
      matched_ = std::move(next);
      ended_ = !more;
      changed_.notify_all();
      changed_.wait(lock, [this] { return !matched_.has_value() || stopped_; });
      if (stopped_) return;
    }
  }

  /// Into the slot ahead, which is this thread's while matched_ is empty.
  Result<Next> match() {
    Matched& slot = slots_[ahead_];
    do {
      DUO_TRY_ASSIGN(const Next next, pairs_.next(slot.pair));
      if (next != Next::kPicture) return next;
      if (read_ == 0) start_ns_ = slot.pair.left.t_ns;
    } while (read_++ < first_);
    slot.engine_ms = timed([&] {
                       engine_.submit(slot.pair);
                       slot.frame = &engine_.collect();
                     }).wall_ms;
    return Next::kPicture;
  }

  ReadAhead pairs_;
  Engine& engine_;
  const std::int64_t first_;
  std::array<Matched, 2> slots_;
  std::mutex mutex_;
  std::condition_variable changed_;
  unsigned ahead_ = 0;                   // slot that the thread fills
  std::optional<Result<Next>> matched_;  // what became of it; empty while the thread works
  bool stopped_ = false, ended_ = false;
  std::int64_t read_ = 0;
  TimeNs start_ns_ = 0;
  std::thread thread_;  // last: it uses all of the above
};

}  // namespace duo::app
