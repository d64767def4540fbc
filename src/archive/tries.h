// Which tasks of a run still want work.
#pragma once

#include <chrono>
#include <map>
#include <string>
#include <unordered_map>
#include <vector>

#include "archive/layout.h"

namespace duo {

/// Starts of each task in this run: what was tried too often is given up.
class Tries {
 public:
  explicit Tries(int retries) : most_(retries + 1) {}
  /// Keys of tasks that nobody works on and that may be started, each once, in the manifest's order.
  std::vector<std::string> wanted(const Batch& batch, const BatchStatus& status) const {
    std::vector<std::string> out;
    std::unordered_map<std::string, bool> taken;
    for (std::size_t i = 0; i < status.tasks.size(); ++i) {
      const std::string& key = batch.tasks()[i].key;
      if (status.tasks[i].state == TaskState::kMissing && may_start(key) && !std::exchange(taken[key], true))
        out.push_back(key);
    }
    return out;
  }
  void started(const std::string& key) { ++starts_[key]; }
  void give_up(const std::string& key) { starts_[key] = most_; }
  bool may_start(const std::string& key) const {
    const auto found = starts_.find(key);
    return found == starts_.end() || found->second < most_;
  }

 private:
  int most_;
  std::unordered_map<std::string, int> starts_;
};

/// When a folder is read again: after a second, and so that reading takes a twentieth of the time at most.
class Pace {
 public:
  using Clock = std::chrono::steady_clock;
  bool due() const { return Clock::now() >= next_; }
  /// Calls `read` and notes how long it takes.
  template <class Read>
  auto timed(Read&& read) {
    const auto start = Clock::now();
    auto out = read();
    const auto end = Clock::now();
    next_ = end + std::max<Clock::duration>(std::chrono::seconds(1), 19 * (end - start));
    return out;
  }

 private:
  Clock::time_point next_{};
};

}  // namespace duo
