// A worker: one task, from its start to the rename that makes it done.
#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <fstream>
#include <map>
#include <sstream>
#include <thread>

#include "archive/layout.h"
#include "archive/process.h"
#include "archive/sha256.h"
#include "archive/summarize.h"
#include "core/clock.h"
#include "core/file.h"

namespace duo {
namespace {

namespace fs = std::filesystem;
using std::chrono::milliseconds;
using std::chrono::steady_clock;

/// A worker's folder, gone with this object.
class WorkFolder {
 public:
  static Result<WorkFolder> make(const fs::path& out, const std::string& key) {
    WorkFolder made(out / kWork / worker_name(key));
    DUO_TRY(make_folder(made.results()));
    return made;
  }
  WorkFolder(WorkFolder&& other) noexcept : path_(std::exchange(other.path_, {})) {}
  WorkFolder& operator=(WorkFolder&&) = delete;
  ~WorkFolder() {
    std::error_code error;
    if (!path_.empty()) fs::remove_all(path_, error);
  }
  fs::path operator/(const char* name) const { return path_ / name; }
  fs::path results() const { return path_ / "results"; }
  /// By the file system's own clock.
  void say_alive() const { ::utimensat(AT_FDCWD, path_.c_str(), nullptr, 0); }

 private:
  explicit WorkFolder(fs::path path) : path_(std::move(path)) {}
  fs::path path_;
};

constexpr char kTracks[] = "people.jsonl";

std::vector<std::string> words_of(const ArchiveTask& task, const BatchTool& tool) {
  std::vector<std::string> words = {tool.program, task.command};
  words.insert(words.end(), task.inputs.begin(), task.inputs.end());
  if (!task.rig.empty()) words.insert(words.end(), {"--rig", task.rig});
  if (task.begin > 0 || task.end > 0)
    words.insert(words.end(), {"--frames", fmt::format("{}:{}", task.begin, task.end > 0 ? std::to_string(task.end) : "")});
  words.insert(words.end(), task.arguments.begin(), task.arguments.end());
  words.insert(words.end(), {"--threads", std::to_string(tool.threads), "-o", task.command == "track" ? kTracks : "."});
  words.emplace_back("--quiet");
  if (task.command == "depth") words.emplace_back("--json");
  return words;
}

/// The lines of a text.
std::vector<std::string> lines_of(const fs::path& path) {
  std::vector<std::string> out;
  std::ifstream file(path);
  constexpr std::size_t kMost = 100;
  for (std::string line; out.size() < kMost && std::getline(file, line);) out.push_back(line);
  return out;
}

/// The command's exit, or none: it was ended because the worker was asked to stop.
Result<std::optional<int>> run_command(const ArchiveTask& task, const BatchTool& tool, const WorkFolder& folder,
                                       const std::function<bool()>& stopped) {
  DUO_TRY_ASSIGN(Process process,
                 Process::start(words_of(task, tool),
                                {.folder = folder.results(), .out = folder / "stdout.txt", .err = folder / "stderr.txt"}));
  auto said_at = steady_clock::now();
  auto nap = milliseconds(2);
  int exit = 0;
  while (!process.has_ended(exit)) {
    if (stopped()) return std::optional<int>();
    std::this_thread::sleep_for(nap);
    nap = std::min(nap * 2, milliseconds(100));
    if (steady_clock::now() - said_at < std::chrono::seconds(5)) continue;
    said_at = steady_clock::now();
    folder.say_alive();
  }
  return stopped() ? std::optional<int>() : std::optional<int>(exit);
}

Result<void> sync_folder(const fs::path& path) {
  const Descriptor folder(::open(path.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
  if (!folder.is_open() || ::fsync(folder.get()) != 0) return write_error(path, errno);
  return {};
}

/// "HASH  PATH" lines, as sha256sum reads them; all bytes are on the disk.
Result<std::string> sums_of(const fs::path& results) {
  std::map<std::string, std::string> sums;
  std::error_code error;
  for (fs::recursive_directory_iterator at(results, error); !error && at != fs::recursive_directory_iterator();
       at.increment(error)) {
    if (at->is_directory(error)) {
      DUO_TRY(sync_folder(at->path()));
      continue;
    }
    DUO_TRY_ASSIGN(sums[at->path().lexically_relative(results)], sha256_of(at->path(), true));
  }
  if (error) return write_error(results, error.value());
  std::string text;
  for (const auto& [name, sum] : sums) text += fmt::format("{}  {}\n", sum, name);
  return text;
}

/// Another worker was first. Equal bits on every machine are promised: a difference is a fault.
Result<Worked> compare(const fs::path& out, const ArchiveTask& task, const WorkFolder& folder) {
  const fs::path first = out / kDone / task.key;
  const auto theirs = read_file(first / kSums, kMostText, "sums"),
             ours = read_file(folder.results() / kSums, kMostText, "sums");
  if (!theirs || !ours) return theirs ? ours.error() : theirs.error();
  if (*theirs == *ours) return Worked{Worked::How::kDoneBefore};
  const std::string name = fmt::format("{}.{}", task.key, random_name());
  const std::string host = read_json_object(first / kDoneFile).value("host", "another host");
  const std::string what = fmt::format(
      "results of {} differ: {} has others than {} had; one of the machines is faulty, or their tools differ; both are kept, "
      "compare {} and {}",
      task.id, host_name(), host, first.string(), (out / kFaults / name).string());
  if (::rename(folder.results().c_str(), (out / kFaults / name).c_str()) != 0) return write_error(out / kFaults / name, errno);
  DUO_TRY(write_file(out / kFaults / (name + ".json"), text_of({{"what", what}})));
  return Worked{Worked::How::kDiffers, 0, what};
}

Result<Worked> finish(const fs::path& out, const ArchiveTask& task, const BatchTool& tool, const WorkFolder& folder, int exit,
                      double seconds) {
  const fs::path results = folder.results();
  DUO_TRY_ASSIGN(const std::string sums, sums_of(results));
  nlohmann::json summary =
      task.command == "track" ? summarize_tracks(results / kTracks) : summarize_depth(folder / "stdout.txt");
  nlohmann::json record = to_json(task);
  record.update({{"key", task.key},
                 {"version", tool.version},
                 {"exit", exit},
                 {"host", host_name()},
                 {"seconds", seconds},
                 {"threads", tool.threads},
                 {"frames", summary.is_object() ? summary.value("frames", std::int64_t{0}) : 0},
                 {"warnings", lines_of(folder / "stderr.txt")},
                 {"summary", std::move(summary)},
                 {"sums_sha256", sha256(sums)}});
  DUO_TRY(write_file(results / kSums, sums));
  DUO_TRY(write_file(results / kDoneFile, text_of(record)));
  DUO_TRY(sync_folder(results));
  const fs::path done = out / kDone / task.key;
  int refused = ::rename(results.c_str(), done.c_str()) == 0 ? 0 : errno;
  const bool taken = refused == EEXIST || refused == ENOTEMPTY;
  if (taken && read_json_object(done / kDoneFile).is_object()) return compare(out, task, folder);
  if (taken) {  // by what no worker leaves, a damaged disk perhaps: kept aside
    const fs::path aside = out / kFaults / fmt::format("{}.{}", task.key, random_name());
    const bool free = ::rename(done.c_str(), aside.c_str()) == 0;
    refused = free && ::rename(results.c_str(), done.c_str()) == 0 ? 0 : errno;
  }
  if (refused != 0) return write_error(done, refused);
  DUO_TRY(sync_folder(out / kDone));
  return Worked{Worked::How::kDone, exit};
}

/// The command's own line on why it failed: the last that it said.
Worked failed(const ArchiveTask& task, const WorkFolder& folder, int exit) {
  const std::vector<std::string> said = lines_of(folder / "stderr.txt");
  const std::string why = exit > 128     ? fmt::format("{} was ended by signal {}", task.command, exit - 128)
                          : said.empty() ? fmt::format("{} ended with {}", task.command, exit)
                                         : said.back();
  return {Worked::How::kFailed, exit, fmt::format("{}: {}", task.id, why)};
}

}  // namespace

Result<Worked> work_on(const fs::path& given, const std::string& key, const BatchTool& tool,
                       const std::function<bool()>& stopped) {
  const fs::path out = whole_path(given);
  DUO_TRY_ASSIGN(const ArchiveTask task, find_task(out, key));
  if (task.inputs.empty())
    return Error{ErrorCode::kNotFound, fmt::format("cannot work on {}: no task of {} has this key", key, out.string())};
  if (read_json_object(out / kDone / key / kDoneFile).is_object()) return Worked{Worked::How::kDoneBefore};
  DUO_TRY_ASSIGN(const WorkFolder folder, WorkFolder::make(out, key));
  const std::int64_t start_ns = wall_ns();
  DUO_TRY_ASSIGN(const std::optional<int> exit, run_command(task, tool, folder, stopped));
  if (!exit) return Worked{Worked::How::kStopped, 0, fmt::format("{}: stopped", task.id)};
  const double seconds = static_cast<double>(wall_ns() - start_ns) * 1e-9;
  Worked worked;
  if (*exit == 0 || *exit == 3) {
    Result<Worked> finished = finish(out, task, tool, folder, *exit, seconds);
    if (finished) return finished;
    const bool full = finished.error().code == ErrorCode::kWriteFailed;
    worked = {Worked::How::kFailed, full ? 5 : 1, fmt::format("{}: {}", task.id, finished.error().what)};
  } else {
    worked = failed(task, folder, *exit);
  }
  // Where no record can be written, who waits for this worker still sees its exit.
  static_cast<void>(
      write_file(out / kFailed / fmt::format("{}.{}.json", key, random_name()),
                 text_of({{"exit", worked.exit}, {"what", worked.what}, {"host", host_name()}, {"seconds", seconds}})));
  return worked;
}

}  // namespace duo
