// The tasks of a batch, their keys, and what its folder says of them.
#include <fmt/format.h>
#include <sys/stat.h>

#include <algorithm>
#include <fstream>
#include <set>
#include <sstream>
#include <unordered_map>
#include <utility>

#include "archive/layout.h"
#include "archive/sha256.h"
#include "core/file.h"

namespace duo {
namespace {

namespace fs = std::filesystem;

/// SHA-256 of files, each read once while its size and time stay.
class Hashes {
 public:
  explicit Hashes(const fs::path& path) : path_(path) {
    std::ifstream file(path);
    for (std::string line; std::getline(file, line);) {
      const std::size_t tab = line.find('\t');  // HASH TAB SIZE TIME PATH
      if (tab == kHashLetters) known_[line.substr(tab + 1)] = line.substr(0, tab);
    }
  }

  /// Errors  the file cannot be read
  Result<std::string> of(const std::string& path, const std::function<void(std::int64_t)>& progress) {
    struct stat there {};
    if (::stat(path.c_str(), &there) != 0)
      return Error{ErrorCode::kNotFound, fmt::format("cannot read file '{}': {}", path, std::strerror(errno))};
    std::string as = fmt::format("{} {}.{:09} {}", there.st_size, there.st_mtim.tv_sec, there.st_mtim.tv_nsec, path);
    const auto found = known_.find(as);
    if (found != known_.end()) return found->second;
    DUO_TRY_ASSIGN(std::string hash, sha256_of(path, false, progress));
    if (path.find('\n') == std::string::npos) new_ += fmt::format("{}\t{}\n", hash, as);
    return known_[as] = hash;
  }
  /// What was read in vain is read again: no error.
  void keep() const {
    if (!new_.empty()) std::ofstream(path_, std::ios::app) << new_;
  }

 private:
  static constexpr std::size_t kHashLetters = 64;
  fs::path path_;
  std::unordered_map<std::string, std::string> known_;
  std::string new_;
};

/// Of all that decides the results. An input that cannot be read has no content: its task fails with the tool's own words, and
/// has another key once it can be read.
std::string key_of(const ArchiveTask& task, const std::string& version, Hashes& hashes,
                   const std::function<void(std::int64_t)>& progress) {
  nlohmann::json contents = nlohmann::json::array();
  const auto add = [&](const std::string& path) {
    const auto hash = hashes.of(path, progress);
    contents.push_back(hash ? *hash : "cannot be read");
  };
  for (const std::string& input : task.inputs) add(input);
  if (!task.rig.empty()) add(task.rig);
  nlohmann::json what = to_json(task);  // with the inputs' names: tracks say what they are of
  what.erase("id");
  const nlohmann::json all = {version, what, contents};
  return sha256(text_of(all)).substr(0, kKeyLetters);
}

}  // namespace

Result<void> write_manifest(const fs::path& out, const std::vector<ArchiveTask>& tasks) {
  std::string text;
  for (const ArchiveTask& task : tasks) text += text_of(to_json(task));
  DUO_TRY(make_folder(out));
  return write_file(out / kManifest, text);
}

Result<std::vector<ArchiveTask>> read_manifest(const fs::path& out) {
  DUO_TRY_ASSIGN(const std::string text, read_file(out / kManifest, kMostText, "manifest"));
  std::vector<ArchiveTask> tasks;
  std::istringstream lines(text);
  std::string line;
  for (int number = 1; std::getline(lines, line); ++number) {
    if (line.find_first_not_of(" \t\r") == std::string::npos) continue;
    DUO_TRY_ASSIGN(ArchiveTask task, task_from(nlohmann::json::parse(line, nullptr, false),
                                               fmt::format("line {} of {}", number, (out / kManifest).string())));
    tasks.push_back(std::move(task));
  }
  if (tasks.empty())
    return Error{ErrorCode::kBadInput, fmt::format("cannot use {}: it has no task", (out / kManifest).string())};
  return tasks;
}

Result<Batch> Batch::open(const fs::path& given, const std::string& version,
                          const std::function<void(std::int64_t)>& progress) {
  Batch batch;
  batch.out_ = whole_path(given);
  if (!batch.out_.has_filename()) batch.out_ = batch.out_.parent_path();  // "out/"
  DUO_TRY_ASSIGN(batch.tasks_, read_manifest(batch.out_));
  Hashes hashes(batch.out_ / kHashes);
  std::vector<std::string> lines;
  std::set<std::string> keys;
  for (ArchiveTask& task : batch.tasks_) {
    task.key = key_of(task, version, hashes, progress);
    if (keys.insert(task.key).second) lines.push_back(task.key + " " + text_of(to_json(task)));
  }
  hashes.keep();
  std::sort(lines.begin(), lines.end());
  std::string text;
  for (const std::string& line : lines) text += line;
  if (const auto before = read_file(batch.out_ / kTasks, kMostText, "tasks"); !before || *before != text)
    DUO_TRY(write_file(batch.out_ / kTasks, text));
  for (const char* name : {kDone, kFailed, kFaults, kWork}) DUO_TRY(make_folder(batch.out_ / name));
  return batch;
}

namespace {

TaskStatus done_by(const nlohmann::json& record) {
  return {.state = TaskState::kDone,
          .exit = record.value("exit", 0),
          .host = record.value("host", ""),
          .seconds = record.value("seconds", 0.0),
          .frames = record.value("frames", std::int64_t{0})};
}

void add_done(const TaskStatus& task, BatchStatus& status) {
  status.cut += task.exit == 3;
  HostSpeed& host = status.hosts[task.host];
  ++host.tasks;
  host.frames += task.frames;
  host.seconds += task.seconds;
}

}  // namespace

Result<BatchStatus> Batch::status() const {
  BatchStatus status;
  status.tasks.resize(tasks_.size());
  std::unordered_map<std::string, std::vector<std::size_t>> by_key;
  for (std::size_t i = 0; i < tasks_.size(); ++i) by_key[tasks_[i].key].push_back(i);
  const auto each = [&](const std::string& name, const auto& visit) {
    const auto found = by_key.find(name.substr(0, kKeyLetters));
    if (found == by_key.end()) return false;
    for (const std::size_t i : found->second) visit(status.tasks[i]);
    return true;
  };
  DUO_TRY_ASSIGN(const auto failures, names_in(out_ / kFailed));
  for (const std::string& name : failures) {
    if (!name.ends_with(".json") || !by_key.contains(name.substr(0, kKeyLetters))) continue;
    const nlohmann::json record = read_json_object(out_ / kFailed / name);
    const int exit = record.is_object() ? record.value("exit", 1) : 1;
    each(name, [&](TaskStatus& task) {
      ++task.failures;
      const bool for_good = exit == 2 || exit == 4;
      if (task.state == TaskState::kFailed && !for_good) return;
      if (for_good) task.state = TaskState::kFailed;
      task.exit = exit;
      if (record.is_object()) task.what = record.value("what", ""), task.host = record.value("host", "");
    });
  }
  const auto now = now_in(out_ / kWork);
  DUO_TRY_ASSIGN(const auto workers, names_in(out_ / kWork));
  for (const std::string& name : workers)
    if (by_key.contains(name.substr(0, kKeyLetters)) && lives(out_ / kWork / name, now))
      each(name, [](TaskStatus& task) { task.state = TaskState::kRunning; });
  DUO_TRY_ASSIGN(const auto done, names_in(out_ / kDone));
  for (const std::string& name : done) {
    if (!by_key.contains(name)) continue;
    auto known = done_.find(name);
    if (known == done_.end()) {
      const nlohmann::json record = read_json_object(out_ / kDone / name / kDoneFile);
      if (!record.is_object()) continue;
      known = done_.emplace(name, done_by(record)).first;
    }
    each(name, [&](TaskStatus& task) {
      const int failures = task.failures;
      task = known->second;
      task.failures = failures;
      add_done(task, status);
    });
  }
  DUO_TRY_ASSIGN(const auto faults, names_in(out_ / kFaults));
  for (const std::string& name : faults)
    if (name.ends_with(".json") && by_key.contains(name.substr(0, kKeyLetters)))
      status.faults.push_back(read_json_object(out_ / kFaults / name).value("what", name));

  double seconds = 0;
  for (std::size_t i = 0; i < status.tasks.size(); ++i) {
    const TaskStatus& task = status.tasks[i];
    status.done += task.state == TaskState::kDone;
    status.running += task.state == TaskState::kRunning;
    status.failed += task.state == TaskState::kFailed;
    status.missing += task.state == TaskState::kMissing;
    if (task.state != TaskState::kDone) continue;
    seconds += task.seconds;
    if (!status.slowest || task.seconds > status.tasks[*status.slowest].seconds) status.slowest = i;
  }
  if (status.done > 0) status.left_s = seconds / status.done * (status.missing + status.running) / std::max(1, status.running);
  return status;
}

void Batch::sweep() const {
  const auto now = now_in(out_ / kWork);
  const auto workers = names_in(out_ / kWork);
  std::error_code error;
  for (const std::string& name : workers ? *workers : std::vector<std::string>()) {
    if (!lives(out_ / kWork / name, now)) fs::remove_all(out_ / kWork / name, error);
  }
}

}  // namespace duo
