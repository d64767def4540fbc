#include "duoptic/worker.h"

#include <condition_variable>
#include <exception>
#include <mutex>
#include <new>
#include <optional>
#include <system_error>
#include <utility>

#include "core/check.h"

namespace duo {

Result<void> without_exceptions(const std::string& what, const std::function<Result<void>()>& work) {
  try {
    return work();
  } catch (const std::bad_alloc&) {
    return Error{ErrorCode::kExhausted, "cannot " + what + ": out of memory; smaller pictures need less"};
  } catch (const std::system_error& e) {
    return Error{ErrorCode::kExhausted, "cannot " + what + ": " + e.code().message()};
  } catch (const std::exception& e) {
    return Error{ErrorCode::kUnsupported, "cannot " + what + ": " + e.what()};
  }
}

struct Worker::Outcome {
  std::mutex mutex;
  std::condition_variable changed;
  std::optional<Result<void>> result;
};

Result<Worker> Worker::start(std::string what, Work work, std::function<void(const Result<void>&)> ended) {
  Worker worker;
  worker.outcome_ = std::make_shared<Outcome>();
  const std::string name = what;
  const auto run = [outcome = worker.outcome_, what = std::move(what), work = std::move(work),
                    ended = std::move(ended)](const std::stop_token& stop) {
    const Result<void> result = without_exceptions(what, [&] { return work(stop); });
    if (ended) ended(result);
    const std::lock_guard lock(outcome->mutex);
    outcome->result = result;
    outcome->changed.notify_all();
  };
  try {
    worker.thread_ = std::jthread(run);
  } catch (const std::system_error& e) {
    return Error{ErrorCode::kExhausted, "cannot start a thread to " + name + ": " + e.code().message() +
                                            "; end other programs, or allow more threads (ulimit -u)"};
  }
  return worker;
}

bool Worker::ends_within(std::chrono::nanoseconds patience) const {
  DUO_CHECK(outcome_ != nullptr);
  std::unique_lock lock(outcome_->mutex);
  return outcome_->changed.wait_for(lock, patience, [this] { return outcome_->result.has_value(); });
}

Result<void> Worker::join() {
  DUO_CHECK(outcome_ != nullptr);
  if (thread_.joinable()) thread_.join();
  const std::lock_guard lock(outcome_->mutex);
  return *outcome_->result;
}

}  // namespace duo
