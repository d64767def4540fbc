// A pool of workers on this machine.
#include <fmt/format.h>
#include <signal.h>

#include <algorithm>
#include <deque>
#include <thread>

#include "archive/process.h"
#include "archive/tries.h"

namespace duo {
namespace {

struct Job {
  std::string key;
  Process worker;
};

class Pool {
 public:
  Pool(const Batch& batch, const RunSetup& setup)
      : batch_(batch),
        setup_(setup),
        tries_(setup.retries),
        most_(static_cast<std::size_t>(setup.jobs > 0 ? setup.jobs
                                                      : std::max(1, static_cast<int>(std::thread::hardware_concurrency())))) {}

  Result<BatchStatus> run() {
    batch_.sweep();
    while (!setup_.stopped()) {
      collect_ended();
      if (pace_.due() || (idle() && !fresh_)) DUO_TRY(look());
      DUO_TRY(fill());
      if (idle() && fresh_ && status_.running == 0) break;
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
    stop();
    batch_.sweep();
    return batch_.status();
  }

 private:
  bool idle() const { return jobs_.empty() && queue_.empty(); }
  /// Reads the folder: what is to be done, also of what another run's worker left.
  Result<void> look() {
    DUO_TRY_ASSIGN(status_, pace_.timed([&] { return batch_.status(); }));
    fresh_ = true;
    const auto wanted = tries_.wanted(batch_, status_);
    queue_.assign(wanted.begin(), wanted.end());
    std::erase_if(queue_, [&](const std::string& key) {
      return std::any_of(jobs_.begin(), jobs_.end(), [&](const Job& job) { return job.key == key; });
    });
    setup_.progress(status_);
    return {};
  }

  Result<void> fill() {
    for (; jobs_.size() < most_ && !queue_.empty(); queue_.pop_front()) {
      const BatchTool& tool = setup_.tool;
      auto worker = Process::start(
          {tool.program, "batch", "work", batch_.folder(), queue_.front(), "--threads", std::to_string(tool.threads)});
      if (!worker && !jobs_.empty()) return {};  // when one of them has ended there is room
      if (!worker) return worker.error();
      tries_.started(queue_.front());
      jobs_.push_back({queue_.front(), std::move(*worker)});
    }
    return {};
  }

  void collect_ended() {
    std::erase_if(jobs_, [&](Job& job) {
      int exit = 0;
      if (!job.worker.has_ended(exit)) return false;
      fresh_ = false;
      if (exit == 4) tries_.give_up(job.key);
      if (exit > 128) setup_.say(fmt::format("a worker was ended by signal {}; its task {}", exit - 128, what_next(job.key)));
      return true;
    });
  }
  const char* what_next(const std::string& key) const {
    return tries_.may_start(key) ? "is started again" : "was tried often enough";
  }

  /// Workers end what they do, and leave nothing of it.
  void stop() {
    for (const Job& job : jobs_) job.worker.send(SIGTERM);
    const auto patience = std::chrono::steady_clock::now() + std::chrono::seconds(10);
    while (!jobs_.empty() && std::chrono::steady_clock::now() < patience) {
      std::erase_if(jobs_, [](Job& job) {
        int exit = 0;
        return job.worker.has_ended(exit);
      });
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
    jobs_.clear();
  }

  const Batch& batch_;
  const RunSetup& setup_;
  Tries tries_;
  const std::size_t most_;
  Pace pace_;
  bool fresh_ = false;  // the folder was read after the last worker ended
  BatchStatus status_;
  std::deque<std::string> queue_;
  std::vector<Job> jobs_;
};

}  // namespace

Result<BatchStatus> run_here(const Batch& batch, const RunSetup& setup) { return Pool(batch, setup).run(); }

}  // namespace duo
