// Job arrays of Slurm. Only the folder says what is done; Slurm is asked for what still waits or runs there.
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <optional>
#include <span>
#include <sstream>
#include <thread>

#include "archive/process.h"
#include "archive/sha256.h"
#include "archive/tries.h"
#include "core/file.h"

namespace duo {
namespace {

namespace fs = std::filesystem;

constexpr char kSlurm[] = "slurm";

/// A line of squeue.
struct Queued {
  std::string state, reason;
};

class Arrays {
 public:
  Arrays(const Batch& batch, const RunSetup& setup)
      : batch_(batch),
        setup_(setup),
        tries_(setup.retries),
        name_("duoptic-" + sha256(batch.folder().string()).substr(0, 12)) {}

  Result<BatchStatus> run() {
    DUO_TRY_ASSIGN(status_, batch_.status());
    if (status_.whole()) return std::move(status_);
    DUO_TRY(prepare());
    while (!setup_.stopped()) {
      // In this order: what Slurm no longer has is in the folder, if it was done.
      const bool answers = read_queue();
      DUO_TRY_ASSIGN(status_, pace_.timed([&] { return batch_.status(); }));
      setup_.progress(status_);
      const std::vector<std::string> wanted = tries_.wanted(batch_, status_);
      const bool given_up = answers && wanted.empty() && at_work_.empty() && status_.running == 0;
      if (status_.whole() || given_up) break;
      if (answers) DUO_TRY(submit(wanted));
      while (!pace_.due() && !setup_.stopped()) std::this_thread::sleep_for(std::chrono::milliseconds(50));
    }
    scancel("--name=" + name_);  // what waits though another did it, and after a stop all
    batch_.sweep();
    return batch_.status();
  }

 private:
  static std::string quoted(const std::string& text) {
    std::string out = "'";
    for (const char c : text) out += c == '\'' ? std::string("'\\''") : std::string(1, c);
    return out + "'";
  }

  /// "NAME  = 1001" of scontrol's lines.
  static std::size_t setting(const std::string& config, const char* name, std::size_t otherwise) {
    const std::size_t at = config.find(name), equals = config.find('=', at);
    if (at == std::string::npos || equals == std::string::npos) return otherwise;
    return std::strtoul(config.c_str() + equals + 1, nullptr, 10);
  }

  Result<void> prepare() {
    // What an earlier run left waiting is submitted anew; what runs is seen in the folder.
    static_cast<void>(ask({"scancel", "--name=" + name_, "--state=PENDING"}));
    batch_.sweep();
    DUO_TRY(make_folder(batch_.folder() / kSlurm));
    const BatchTool& tool = setup_.tool;
    DUO_TRY(write_file(batch_.folder() / kSlurm / "task.sh",
                       fmt::format("#!/bin/sh\n"
                                   "# A task of duoptic batch: its key is a line of the list.\n"
                                   "key=$(sed -n \"$((SLURM_ARRAY_TASK_ID + 1))p\" \"$1\") || exit 1\n"
                                   "exec {} batch work {} \"$key\" --threads {}\n",
                                   quoted(tool.program), quoted(batch_.folder()), tool.threads)));
    if (const auto config = ask({"scontrol", "show", "config"}); config && config->exit == 0) {
      most_in_array_ = std::clamp<std::size_t>(setting(config->out, "MaxArraySize", most_in_array_ + 1), 2, 100'001) - 1;
      most_at_once_ = std::max(2 * most_in_array_, setting(config->out, "MaxJobCount", 0) / 2);  // others have jobs, too
    }
    return {};
  }

  /// What waits and runs of ours; false while the controller does not answer: the folder is still read, and nothing submitted.
  bool read_queue() {
    const auto answer = ask({"squeue", "--noheader", "--array", "--name=" + name_, "--format=%F %K %T %r"});
    const bool answers = answer && answer->exit == 0;
    if (answers != answers_)
      setup_.say(answers ? "Slurm's controller answers again" : "Slurm's controller does not answer: waiting for it");
    answers_ = answers;
    if (!answers) return false;
    std::map<std::string, Queued> queue;
    std::istringstream lines(answer->out);
    for (std::string line; std::getline(lines, line);) {
      std::istringstream words(line);
      std::string job, index;
      Queued queued;
      words >> job >> index >> queued.state;
      std::getline(words >> std::ws, queued.reason);
      queue[job + "_" + index] = std::move(queued);
    }
    std::erase_if(at_work_, [&](const auto& entry) { return !stays(entry.second, queue); });
    return true;
  }

  /// Whether Slurm still has the job and will run it.
  bool stays(const std::string& job, const std::map<std::string, Queued>& queue) {
    const auto found = queue.find(job);
    if (found == queue.end()) return false;
    const auto& [state, reason] = found->second;
    if (state != "PENDING") return true;
    // A requeued job waits for two minutes, as if its node might come back.
    if (reason == "BeginTime") static_cast<void>(ask({"scontrol", "update", "JobId=" + job, "StartTime=now"}));
    if (!reason.starts_with("JobHeld") && !reason.starts_with("launch failed") && reason != "DependencyNeverSatisfied")
      return true;
    setup_.say(fmt::format("Slurm holds job {} ({}): it is cancelled and its task submitted again", job, reason));
    scancel(job);
    return false;
  }

  void scancel(const std::string& what) const { static_cast<void>(ask({"scancel", what})); }

  /// The wanted tasks that Slurm does not have, as arrays.
  Result<void> submit(std::vector<std::string> wanted) {
    std::erase_if(wanted, [&](const std::string& key) { return at_work_.contains(key); });
    const std::size_t most = std::max(most_at_once_, at_work_.size()) - at_work_.size();
    if (wanted.size() > most) wanted.resize(most);
    for (std::size_t at = 0; at < wanted.size(); at += most_in_array_) {
      const std::size_t count = std::min(most_in_array_, wanted.size() - at);
      DUO_TRY_ASSIGN(const bool taken, submit(std::span(wanted).subspan(at, count)));
      if (!taken) return {};
    }
    return {};
  }

  /// False where the controller is away just now.
  Result<bool> submit(std::span<const std::string> keys) {
    std::string list;
    for (const std::string& key : keys) list += key + "\n";
    const fs::path todo = batch_.folder() / kSlurm / fmt::format("todo.{}.txt", random_name());  // never written again
    DUO_TRY(write_file(todo, list));
    std::string array = fmt::format("--array=0-{}", keys.size() - 1);
    if (setup_.jobs > 0) array += fmt::format("%{}", setup_.jobs);
    std::vector<std::string> words = {"sbatch",
                                      "--parsable",
                                      "--job-name=" + name_,
                                      array,
                                      "--requeue",
                                      "--signal=B:TERM@30",
                                      "--open-mode=append",
                                      fmt::format("--cpus-per-task={}", setup_.tool.threads),
                                      fmt::format("--output={}", (batch_.folder() / kSlurm / "%A_%a.txt").string())};
    words.insert(words.end(), setup_.sbatch.begin(), setup_.sbatch.end());
    words.insert(words.end(), {(batch_.folder() / kSlurm / "task.sh").string(), todo.string()});
    DUO_TRY_ASSIGN(const Answer answer, ask(words));
    if (answer.exit != 0) {
      constexpr int kMostRefusals = 5;
      if (++refusals_ < kMostRefusals) return false;
      return Error{ErrorCode::kUnsupported,
                   fmt::format("cannot submit to Slurm: {}", answer.err.substr(0, answer.err.find('\n')))};
    }
    refusals_ = 0;
    const std::string job = answer.out.substr(0, answer.out.find_first_of(";\n"));
    for (std::size_t i = 0; i < keys.size(); ++i) {
      at_work_[keys[i]] = fmt::format("{}_{}", job, i);
      tries_.started(keys[i]);
    }
    return true;
  }

  const Batch& batch_;
  const RunSetup& setup_;
  Tries tries_;
  const std::string name_;  // of the jobs of this folder
  std::size_t most_in_array_ = 1000, most_at_once_ = 2000;
  bool answers_ = true;
  int refusals_ = 0;
  Pace pace_;
  BatchStatus status_;
  std::map<std::string, std::string> at_work_;  // key: job that Slurm has of it
};

}  // namespace

bool has_slurm() {
  std::istringstream folders(std::getenv("PATH") != nullptr ? std::getenv("PATH") : "");
  for (std::string folder; std::getline(folders, folder, ':');)
    if (::access((fs::path(folder) / "sbatch").c_str(), X_OK) == 0) return true;
  return false;
}

Result<BatchStatus> run_on_slurm(const Batch& batch, const RunSetup& setup) {
  if (!has_slurm())
    return Error{ErrorCode::kUnsupported,
                 "cannot submit to Slurm: there is no sbatch; use --local, or a machine of the cluster"};
  return Arrays(batch, setup).run();
}

}  // namespace duo
