// One table of all recordings, and their results by name.
#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "archive/layout.h"
#include "core/file.h"
#include "core/json_text.h"

namespace duo {
namespace {

namespace fs = std::filesystem;

constexpr const char* kStates[] = {"seen", "inferred", "lost"};

const char* name_of(TaskState state) {
  switch (state) {
    case TaskState::kMissing:
      return "missing";
    case TaskState::kRunning:
      return "running";
    case TaskState::kDone:
      return "done";
    case TaskState::kFailed:
      return "failed";
  }
  return "";
}

/// A recording: all of its tasks together.
struct Row {
  std::string command;
  TaskState state = TaskState::kDone;  // of the task that is farthest from done
  bool cut = false;
  std::int64_t frames = 0, people = 0;
  double seconds = 0, covered = 0;  // covered: percent times frames
  std::string rig;
  std::vector<std::string> warnings, results;
  std::map<std::string, std::map<std::string, std::int64_t>> joints;

  void add(const ArchiveTask& task, const TaskStatus& status, const fs::path& out) {
    command = task.command;
    const auto rank = [](TaskState s) {
      return s == TaskState::kDone ? 0 : s == TaskState::kRunning ? 1 : s == TaskState::kMissing ? 2 : 3;
    };
    if (rank(status.state) > rank(state)) state = status.state;
    if (!status.what.empty()) warnings.push_back(status.what);
    if (status.state != TaskState::kDone) return;
    cut |= status.exit == 3;
    seconds += status.seconds;
    frames += status.frames;
    results.push_back(fs::path(kDone) / task.key);
    const nlohmann::json record = read_json_object(out / kDone / task.key / kDoneFile);
    for (const auto& line : record.value("warnings", nlohmann::json::array())) warnings.push_back(line);
    const nlohmann::json summary = record.value("summary", nlohmann::json());
    if (!summary.is_object()) return;
    people += summary.value("people", std::int64_t{0});
    covered += summary.value("coverage_percent", 0.0) * static_cast<double>(status.frames);
    if (rig.empty() || rig == "good") rig = summary.value("rig", rig);
    const nlohmann::json of_joints = summary.value("joints", nlohmann::json::object());
    for (const auto& [joint, counts] : of_joints.items())
      for (const char* name : kStates) joints[joint][name] += counts.value(name, std::int64_t{0});
  }
  static double share(const std::map<std::string, std::int64_t>& counts, const char* name) {
    std::int64_t all = 0;
    for (const auto& [state, count] : counts) all += count;
    return all > 0 ? static_cast<double>(counts.at(name)) / static_cast<double>(all) : 0;
  }
  double per_frame(double sum) const { return frames > 0 ? sum / static_cast<double>(frames) : 0; }
  double frames_per_s() const { return seconds > 0 ? static_cast<double>(frames) / seconds : 0; }
};

nlohmann::json to_json(const std::string& id, const Row& row) {
  nlohmann::json joints = nlohmann::json::object();
  for (const auto& [joint, counts] : row.joints)
    for (const char* name : kStates) joints[joint][name] = Row::share(counts, name);
  const bool depth = row.command == "depth";
  return {{"id", id},
          {"command", row.command},
          {"state", name_of(row.state)},
          {"cut", row.cut},
          {"frames", row.frames},
          {"people_per_frame", depth ? nlohmann::json() : nlohmann::json(row.per_frame(static_cast<double>(row.people)))},
          {"coverage_percent", depth ? nlohmann::json(row.per_frame(row.covered)) : nlohmann::json()},
          {"rig", row.rig.empty() ? nlohmann::json() : nlohmann::json(row.rig)},
          {"seconds", row.seconds},
          {"frames_per_s", row.frames_per_s()},
          {"joints", joints},
          {"warnings", row.warnings},
          {"results", row.results}};
}

std::string csv_text(const std::string& text) {
  if (text.find_first_of(",\"\n") == std::string::npos) return text;
  std::string out = "\"";
  for (const char c : text) out += c == '"' ? std::string("\"\"") : std::string(1, c);
  return out + "\"";
}

std::string csv_of(const std::map<std::string, Row>& rows) {
  std::map<std::string, int> joints;
  for (const auto& [id, row] : rows)
    for (const auto& [joint, counts] : row.joints) joints[joint] = 1;
  std::string text = "id,command,state,cut,frames,people_per_frame,coverage_percent,rig,seconds,frames_per_s,warnings";
  for (const auto& [joint, unused] : joints)
    for (const char* name : kStates) text += fmt::format(",{}_{}", joint, name);
  text += "\n";
  for (const auto& [id, row] : rows) {
    const bool depth = row.command == "depth";
    text +=
        fmt::format("{},{},{},{},{},{},{},{},{:.2f},{:.2f},{}", csv_text(id), row.command, name_of(row.state), row.cut ? 1 : 0,
                    row.frames, depth ? "" : fmt::format("{:.3f}", row.per_frame(static_cast<double>(row.people))),
                    depth ? fmt::format("{:.2f}", row.per_frame(row.covered)) : "", csv_text(row.rig), row.seconds,
                    row.frames_per_s(), csv_text(fmt::format("{}", fmt::join(row.warnings, "; "))));
    for (const auto& [joint, unused] : joints) {
      const auto counts = row.joints.find(joint);
      for (const char* name : kStates)
        text += counts == row.joints.end() ? "," : fmt::format(",{:.4f}", Row::share(counts->second, name));
    }
    text += "\n";
  }
  return text;
}

/// by-name/ID, or by-name/ID.0000003000 for a range of frames: a link, and nothing else that has the name is touched.
void link_by_name(const fs::path& out, const ArchiveTask& task) {
  std::error_code error;
  std::string name = task.id;
  if (task.begin > 0 || task.end > 0) name += fmt::format(".{:010}", task.begin);
  const fs::path link = (out / "by-name" / name).lexically_normal();
  if (!link.native().starts_with((out / "by-name").native() + "/")) return;  // an id with ..
  fs::create_directories(link.parent_path(), error);
  const fs::path target = (out / kDone / task.key).lexically_relative(link.parent_path());
  if (fs::is_symlink(link, error) && fs::read_symlink(link, error) != target) fs::remove(link, error);
  if (!fs::exists(fs::symlink_status(link, error))) fs::create_directory_symlink(target, link, error);
}

}  // namespace

Result<std::vector<fs::path>> collect(const Batch& batch) {
  DUO_TRY_ASSIGN(const BatchStatus status, batch.status());
  std::map<std::string, Row> rows;
  for (std::size_t i = 0; i < status.tasks.size(); ++i) {
    const ArchiveTask& task = batch.tasks()[i];
    rows[task.id].add(task, status.tasks[i], batch.folder());
    if (status.tasks[i].state == TaskState::kDone) link_by_name(batch.folder(), task);
  }
  nlohmann::json table = nlohmann::json::array();
  for (const auto& [id, row] : rows) table.push_back(to_json(id, row));
  const fs::path json = batch.folder() / "table.json", csv = batch.folder() / "table.csv";
  DUO_TRY(write_file(json, json_text(table, 1) + "\n"));
  DUO_TRY(write_file(csv, csv_of(rows)));
  return std::vector<fs::path>{json, csv};
}

}  // namespace duo
