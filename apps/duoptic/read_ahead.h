// Reads the next pair while the last one is worked on.
#pragma once

#include <condition_variable>
#include <memory>
#include <mutex>
#include <new>
#include <optional>
#include <thread>
#include <utility>

#include "duoptic/source.h"

namespace duo::app {

/// A pair source with a thread of its own, one pair ahead. The same pairs in the same order; two pairs' memory goes around.
class ReadAhead {
 public:
  explicit ReadAhead(std::unique_ptr<PairSource> pairs) : pairs_(std::move(pairs)), thread_([this] { read_all(); }) {}
  ~ReadAhead() {
    {
      const std::lock_guard lock(mutex_);
      stopped_ = true;
    }
    changed_.notify_all();
    thread_.join();
  }

  std::int64_t count() const { return count_; }
  /// As PairSource::next(); not to be called again after the end or an error.
  Result<Next> next(Pair& into) {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [this] { return read_.has_value(); });
    std::swap(into, ahead_);
    Result<Next> next = *std::exchange(read_, std::nullopt);
    lock.unlock();
    changed_.notify_all();
    return next;
  }
  /// After the end, as PairSource::warning().
  std::string warning() const { return pairs_->warning(); }

 private:
  void read_all() {
    for (bool more = true; more;) {
      Result<Next> next = read();
      more = next && *next == Next::kPicture;
      std::unique_lock lock(mutex_);
      read_ = std::move(next);
      changed_.notify_all();
      changed_.wait(lock, [this] { return !read_.has_value() || stopped_; });
      if (stopped_) return;
    }
  }

  /// Into ahead_, which is this thread's while read_ is empty; nothing may be thrown out of a thread.
  Result<Next> read() {
    try {
      return pairs_->next(ahead_);
    } catch (const std::bad_alloc&) {
      return Error{ErrorCode::kUnsupported, "cannot read the next pair: out of memory; smaller pictures need less"};
    }
  }

  std::unique_ptr<PairSource> pairs_;
  const std::int64_t count_ = pairs_->count();
  std::mutex mutex_;
  std::condition_variable changed_;
  Pair ahead_;
  std::optional<Result<Next>> read_;  // what became of ahead_; empty while the thread reads
  bool stopped_ = false;
  std::thread thread_;  // last: it uses all of the above
};

}  // namespace duo::app
