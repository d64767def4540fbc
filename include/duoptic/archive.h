// Archives: many recordings, each worked on by the tool in a process of its own, on one machine or on many that share a folder.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <unordered_map>
#include <vector>

#include "duoptic/result.h"

#pragma GCC visibility push(default)
namespace duo {

/// One piece of work: a recording, or a range of its frames.
struct ArchiveTask {
  std::string id;                           // of the recording: its path in the archive, without side and ending
  std::vector<std::string> inputs;          // absolute paths: LEFT and RIGHT, or one file with both views
  std::string rig = {};                     // absolute path; empty: the recording brings its own
  std::string command = "track";            // or depth
  std::vector<std::string> arguments = {};  // further ones of the command; none that names an output
  std::int64_t begin = 0, end = 0;          // frames begin .. end-1; end 0: up to the last
  std::string key = {};                     // of what decides the results; see Batch::open()
};

struct ArchiveWish {
  std::string command = "track";
  std::vector<std::string> arguments = {};
  std::string rig = {};           // of all recordings; empty: the nearest rig file of each
  std::int64_t shard_frames = 0;  // of depth: frames of a task; 0: some 45 s of one thread's work
};

struct ArchivePlan {
  std::vector<ArchiveTask> tasks;     // by id
  std::vector<std::string> left_out;  // a line for each video that makes no task
};

/// Finds recordings in a folder and in those below it. Two videos whose names, or whose folders' names, differ in `left` and
/// `right` (or `l` and `r`) alone are a pair; any other video holds both views. Its rig is the nearest: `NAME_rig.json` beside
/// it, else rig.*, calibration.*, calibration_truth.yml or camchain.yaml in its folder or one above it; a Matroska file that
/// holds a rig brings its own.
///
/// Errors  the folder cannot be read; it holds no video
Result<ArchivePlan> plan_archive(const std::filesystem::path& archive, const ArchiveWish& wish);

/// OUT/manifest.jsonl: one JSON object per task, to be read and edited.
///
/// Errors  those of writing; reading: the first line that is no task, or names another command than track and depth
Result<void> write_manifest(const std::filesystem::path& out, const std::vector<ArchiveTask>& tasks);
Result<std::vector<ArchiveTask>> read_manifest(const std::filesystem::path& out);

enum class TaskState : std::uint8_t {
  kMissing,  // nobody works on it
  kRunning,
  kDone,
  kFailed,  // by its input or options: the same again would fail again
};

struct TaskStatus {
  TaskState state = TaskState::kMissing;
  int exit = 0;           // of the command: done with 3 has a cut input
  int failures = 0;       // so far
  std::string what = {};  // of the last failure, the command's own line
  std::string host = {};
  double seconds = 0;
  std::int64_t frames = 0;
};

struct HostSpeed {
  int tasks = 0;
  std::int64_t frames = 0;
  double seconds = 0;  // of all tasks
};

struct BatchStatus {
  std::vector<TaskStatus> tasks;                                // in the manifest's order
  int done = 0, cut = 0, running = 0, failed = 0, missing = 0;  // cut ones are done, too
  std::map<std::string, HostSpeed> hosts;
  std::vector<std::string> faults;  // a line for each task that two workers had different results of
  std::optional<std::size_t> slowest;
  std::optional<double> left_s;  // by the mean time of a task and those that run; none: not known
  bool whole() const { return missing == 0 && running == 0; }
};

/// What the work is done with.
struct BatchTool {
  std::filesystem::path program;  // absolute: this tool
  std::string version;            // results of one version are the same everywhere
  int threads = 1;                // of a task
};

/// A folder with a manifest and the results of its tasks. The folder alone says what is done: a task's results appear together
/// with the record of their hashes, by one rename, or not at all.
///
///     manifest.jsonl    the tasks
///     done/KEY/         results, SHA256SUMS of them, done.json
///     failed/           a record of each failure
///     faults/           results that differ from those that another worker had
///     work/             of workers: each has a folder there while it lives
///     tasks.txt, hashes.txt   the tasks by key, and hashes of inputs by path, size and time
///
/// Threads  one caller; any number of processes on any number of machines that see the folder
class Batch {
 public:
  /// Reads the manifest. A task's key is the SHA-256 of version, command, arguments, frames and the contents of its inputs,
  /// of which each is read once. `progress`: bytes read so far.
  ///
  /// Errors  those of read_manifest(); the folder cannot be written
  static Result<Batch> open(const std::filesystem::path& out, const std::string& version,
                            const std::function<void(std::int64_t)>& progress = {});
  const std::filesystem::path& folder() const { return out_; }
  const std::vector<ArchiveTask>& tasks() const { return tasks_; }
  /// Reads the folder; the record of a task that is done is read once.
  ///
  /// Errors  it cannot be read
  Result<BatchStatus> status() const;
  /// Removes what dead workers left.
  void sweep() const;

 private:
  std::filesystem::path out_;
  std::vector<ArchiveTask> tasks_;
  mutable std::unordered_map<std::string, TaskStatus> done_;  // by key
};

/// How a task ended.
struct Worked {
  enum class How : std::uint8_t { kDone, kDoneBefore, kStopped, kFailed, kDiffers } how = How::kDone;
  int exit = 0;           // of the command; 128 + a signal
  std::string what = {};  // of what is not done: one line
};

/// What a worker does: one task, by a process of the tool. `stopped` is asked again and again; then the process is ended, and
/// nothing of it is left.
///
/// Errors  no such task; the folder cannot be written
Result<Worked> work_on(const std::filesystem::path& out, const std::string& key, const BatchTool& tool,
                       const std::function<bool()>& stopped);

struct RunSetup {
  BatchTool tool;
  int jobs = 0;                          // tasks at once; 0: here one per core, of a cluster all
  int retries = 3;                       // further tries of what failed, but not by its input
  std::vector<std::string> sbatch = {};  // of a cluster: further arguments of sbatch
  std::function<bool()> stopped = [] { return false; };
  std::function<void(const BatchStatus&)> progress = [](const BatchStatus&) {};  // about once a second
  std::function<void(const std::string&)> say = [](const std::string&) {};       // a line of what went wrong on the way
};

/// Works until each task is done, has failed for good, or was tried often enough; or until it is stopped. Tasks that others
/// work on are waited for.
///
/// Errors  the folder cannot be read or written; no process can be started
Result<BatchStatus> run_here(const Batch& batch, const RunSetup& setup);
/// The same by job arrays of Slurm. The folder is asked for what is done, Slurm only for what still waits or runs: what neither
/// has is submitted again.
///
/// Errors  those of run_here(); sbatch refuses the job
Result<BatchStatus> run_on_slurm(const Batch& batch, const RunSetup& setup);
/// Whether sbatch is there.
bool has_slurm();

/// table.json and table.csv in the folder: a row per recording; and by-name/ID, links to the results. The table's columns are
/// described in docs/batch.md.
///
/// Returns  the paths of both files
/// Errors   those of Batch::status() and of writing
Result<std::vector<std::filesystem::path>> collect(const Batch& batch);

}  // namespace duo
#pragma GCC visibility pop
