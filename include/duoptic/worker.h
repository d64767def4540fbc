// A thread for one piece of work, whose failures are results.
#pragma once

#include <chrono>
#include <functional>
#include <memory>
#include <stop_token>
#include <string>
#include <thread>

#include "duoptic/result.h"

namespace [[gnu::visibility("default")]] duo {

/// Calls `work`; what it throws becomes an Error. `what` completes "cannot ...": "read the next pair".
Result<void> without_exceptions(const std::string& what, const std::function<Result<void>()>& work);

/// A thread that does one piece of work. The destructor asks the work to stop and waits for it.
///
/// Threads  one caller
class Worker {
 public:
  using Work = std::function<Result<void>(const std::stop_token&)>;

  Worker() = default;
  /// Starts a thread that calls `work`, then `ended` with what came of it; `ended` must not throw. For `what` see
  /// without_exceptions(): an exception ends the work with an error, not the program.
  ///
  /// Errors  the system gives no thread
  static Result<Worker> start(std::string what, Work work, std::function<void(const Result<void>&)> ended = {});
  Worker(Worker&&) noexcept = default;
  Worker& operator=(Worker&&) noexcept = default;

  bool started() const { return outcome_ != nullptr; }
  void ask_to_stop() { thread_.request_stop(); }
  /// Waits for the end of the work, `patience` at most; whether it has ended.
  bool ends_within(std::chrono::nanoseconds patience) const;
  /// Waits for the end of the work; what came of it.
  Result<void> join();
  /// Lets a thread go that cannot be ended. What its work uses must belong to the work.
  void detach() { thread_.detach(); }

 private:
  struct Outcome;
  std::shared_ptr<Outcome> outcome_;
  std::jthread thread_;
};

}  // namespace duo
