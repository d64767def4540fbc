// A queue of fixed capacity between threads.
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <mutex>
#include <optional>
#include <utility>
#include <vector>

#include "duoptic/result.h"

namespace [[gnu::visibility("default")]] duo {

/// What put() does to a full queue.
enum class WhenFull : std::uint8_t {
  kWait,        // waits until a value is taken: each value arrives, in order
  kDropOldest,  // drops the oldest value and counts it: with a capacity of 1 the newest wins
};

enum class Taken : std::uint8_t {
  kValue,
  kNothing,  // none came in time
  kClosed,   // none will come
};

/// A bounded queue. Values are swapped in and out, so that their memory goes around; nothing is allocated after the
/// constructor.
///
/// Threads  any
template <class T>
class BoundedQueue {
 public:
  using Patience = std::chrono::nanoseconds;

  BoundedQueue(std::size_t capacity, WhenFull when_full) : ring_(capacity), when_full_(when_full) {}

  /// Swaps `value` with what lies in the free place. False where the queue is closed: `value` is then as it was.
  bool put(T& value) {
    {
      std::unique_lock lock(mutex_);
      if (when_full_ == WhenFull::kWait) room_.wait(lock, [this] { return closed_ || count_ < ring_.size(); });
      if (closed_) return false;
      if (count_ == ring_.size()) {
        drop_oldest();
        ++dropped_;
      }
      std::swap(ring_[(first_ + count_) % ring_.size()], value);
      ++count_;
    }
    news_.notify_one();
    return true;
  }

  /// Swaps the oldest value into `into`; waits for it, at most `patience` where that is given.
  ///
  /// Errors  what close() was given, once all values are taken
  Result<Taken> take(T& into, std::optional<Patience> patience = std::nullopt) {
    std::unique_lock lock(mutex_);
    const auto ready = [this] { return closed_ || count_ > 0; };
    if (!patience)
      news_.wait(lock, ready);
    else if (!news_.wait_for(lock, *patience, ready))
      return Taken::kNothing;
    if (count_ == 0) {
      if (!why_) return why_.error();
      return Taken::kClosed;
    }
    std::swap(into, ring_[first_]);
    drop_oldest();
    lock.unlock();
    room_.notify_one();
    return Taken::kValue;
  }

  /// Waits until put() would not have to; false where the queue is closed. For the only one who puts.
  bool wait_for_room() {
    std::unique_lock lock(mutex_);
    room_.wait(lock, [this] { return closed_ || count_ < ring_.size(); });
    return !closed_;
  }

  /// Waits until there is a value or the end.
  void wait() {
    std::unique_lock lock(mutex_);
    news_.wait(lock, [this] { return closed_ || count_ > 0; });
  }

  /// Nothing can be put any more; what is in the queue can still be taken. Only the first call counts.
  void close(Result<void> why = {}) {
    {
      const std::lock_guard lock(mutex_);
      if (closed_) return;
      closed_ = true;
      why_ = std::move(why);
    }
    news_.notify_all();
    room_.notify_all();
  }

  std::int64_t dropped() const {
    const std::lock_guard lock(mutex_);
    return dropped_;
  }

 private:
  void drop_oldest() {
    first_ = (first_ + 1) % ring_.size();
    --count_;
  }

  mutable std::mutex mutex_;
  std::condition_variable news_, room_;
  std::vector<T> ring_;  // count_ values from first_; the other places hold memory to use again
  const WhenFull when_full_;
  std::size_t first_ = 0, count_ = 0;
  std::int64_t dropped_ = 0;
  bool closed_ = false;
  Result<void> why_;
};

}  // namespace duo
