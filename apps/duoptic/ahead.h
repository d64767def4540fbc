// Makes the next thing while the last one is worked on.
#pragma once

#include <condition_variable>
#include <functional>
#include <mutex>
#include <new>
#include <optional>
#include <thread>
#include <utility>

#include "duoptic/result.h"
#include "duoptic/source.h"

namespace duo::app {

/// A thread that makes things, one ahead of who takes them; the same in the same order. Two things' memory goes around.
template <class T>
class Ahead {
 public:
  /// `make` is called in the thread, until it gives an end or an error. What it uses must outlive this.
  explicit Ahead(std::function<Result<Next>(T&)> make) : make_(std::move(make)), thread_([this] { make_all(); }) {}
  ~Ahead() {
    {
      const std::lock_guard lock(mutex_);
      stopped_ = true;
    }
    changed_.notify_all();
    thread_.join();
  }

  /// As `make`, but only a picture changes `into`; not to be called again after the end or an error.
  Result<Next> next(T& into) {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [this] { return made_.has_value(); });
    Result<Next> next = *std::exchange(made_, std::nullopt);
    if (next && *next == Next::kPicture) std::swap(into, ahead_);
    lock.unlock();
    changed_.notify_all();
    return next;
  }
  /// Before the end: until the next one is ready; then nothing goes on in the thread.
  void wait() {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [this] { return made_.has_value(); });
  }
  /// Before the end: calls `change` with what is ready, null when that is nothing, while nothing goes on in the thread.
  template <class F>
  void amend(F&& change) {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [this] { return made_.has_value(); });
    change(*made_ && **made_ == Next::kPicture ? &ahead_ : nullptr);
  }

 private:
  void make_all() {
    for (bool more = true; more;) {
      Result<Next> next = make();
      more = next && (*next == Next::kPicture || *next == Next::kNothing);
      std::unique_lock lock(mutex_);
      made_ = std::move(next);
      changed_.notify_all();
      changed_.wait(lock, [this] { return !made_.has_value() || stopped_; });
      if (stopped_) return;
    }
  }

  /// Into ahead_, which is this thread's while made_ is empty; nothing may be thrown out of a thread.
  Result<Next> make() {
    try {
      return make_(ahead_);
    } catch (const std::bad_alloc&) {
      return Error{ErrorCode::kUnsupported, "cannot read the next pair: out of memory; smaller pictures need less"};
    }
  }

  std::function<Result<Next>(T&)> make_;
  std::mutex mutex_;
  std::condition_variable changed_;
  T ahead_;
  std::optional<Result<Next>> made_;  // what became of ahead_; empty while the thread works
  bool stopped_ = false;
  std::thread thread_;  // last: it uses all of the above
};

}  // namespace duo::app
