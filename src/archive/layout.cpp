#include "archive/layout.h"

#include <fmt/format.h>
#include <sys/random.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <fstream>
#include <sstream>

#include "archive/sha256.h"
#include "core/file.h"
#include "core/json_text.h"

namespace duo {

namespace fs = std::filesystem;

nlohmann::json to_json(const ArchiveTask& task) {
  nlohmann::json out = {{"id", task.id}, {"inputs", task.inputs}, {"command", task.command}, {"arguments", task.arguments}};
  out["rig"] = task.rig.empty() ? nlohmann::json() : nlohmann::json(task.rig);
  if (task.begin > 0 || task.end > 0) out["frames"] = {task.begin, task.end > 0 ? nlohmann::json(task.end) : nlohmann::json()};
  return out;
}

Result<ArchiveTask> task_from(const nlohmann::json& json, const std::string& where) {
  const auto wrong = [&](const char* why) { return Error{ErrorCode::kBadInput, fmt::format("cannot use {}: {}", where, why)}; };
  const auto strings = [](const nlohmann::json& list) {
    return list.is_array() && std::all_of(list.begin(), list.end(), [](const auto& one) { return one.is_string(); });
  };
  if (!json.is_object()) return wrong("it is no JSON object");
  const nlohmann::json inputs = json.value("inputs", nlohmann::json()),
                       arguments = json.value("arguments", nlohmann::json::array()), rig = json.value("rig", nlohmann::json()),
                       frames = json.value("frames", nlohmann::json()), id = json.value("id", nlohmann::json()),
                       command = json.value("command", nlohmann::json());
  if (!id.is_string() || id.get_ref<const std::string&>().empty()) return wrong("it has no id");
  if (!strings(inputs) || inputs.empty() || inputs.size() > 2) return wrong("inputs is not a list of one or two files");
  if (!strings(arguments)) return wrong("arguments is not a list of words");
  if (!rig.is_null() && !rig.is_string()) return wrong("rig is neither a file nor null");
  if (command != "track" && command != "depth") return wrong("command is neither track nor depth");
  ArchiveTask task{.id = id, .inputs = inputs, .command = command, .arguments = arguments};
  if (rig.is_string()) task.rig = rig;
  if (frames.is_null()) return task;
  const bool range = frames.is_array() && frames.size() == 2 && frames[0].is_number_unsigned() &&
                     (frames[1].is_null() || (frames[1].is_number_unsigned() && frames[1] > frames[0]));
  if (!range || command != "depth") return wrong("frames is not [A,B] or [A,null] with A < B, of depth");
  task.begin = frames[0];
  if (!frames[1].is_null()) task.end = frames[1];
  return task;
}

nlohmann::json read_json_object(const fs::path& path) {
  const auto text = read_file(path, kMostText, "record");
  if (!text) return nullptr;
  nlohmann::json json = nlohmann::json::parse(*text, nullptr, false);
  return json.is_object() ? json : nlohmann::json();
}

std::string text_of(const nlohmann::json& json) {
  return json_text(json, -1) + "\n";
}

fs::path whole_path(const fs::path& path) {
  std::error_code error;
  const fs::path whole = fs::absolute(path, error);
  return (error ? path : whole).lexically_normal();
}

bool is_file(const fs::path& path) {
  std::error_code error;
  return fs::is_regular_file(path, error);
}

Result<void> make_folder(const fs::path& path) {
  std::error_code error;
  fs::create_directories(path, error);
  if (error) return write_error(path, error.value());
  return {};
}

Result<std::vector<std::string>> names_in(const fs::path& folder) {
  std::vector<std::string> out;
  std::error_code error;
  for (fs::directory_iterator at(folder, error); !error && at != fs::directory_iterator(); at.increment(error))
    out.push_back(at->path().filename());
  if (error && error != std::errc::no_such_file_or_directory)
    return Error{ErrorCode::kBadInput, fmt::format("cannot read folder '{}': {}", folder.string(), error.message())};
  std::sort(out.begin(), out.end());
  return out;
}

std::string random_name() {
  unsigned char bytes[12] = {};
  if (::getrandom(bytes, sizeof bytes, 0) != sizeof bytes) return fmt::format("p{}", ::getpid());
  std::string out;
  for (const unsigned char byte : bytes) out += static_cast<char>('a' + byte % 26);
  return out;
}

namespace {

std::string first_line(const fs::path& path) {
  std::ifstream file(path);
  std::string line;
  std::getline(file, line);
  return line;
}

/// Of a process: when it began, in ticks since the machine did; empty where there is none.
std::string began(const std::string& pid) {
  const std::string line = first_line("/proc/" + pid + "/stat");
  const std::size_t name_end = line.rfind(')');  // of field 2
  if (name_end == std::string::npos) return {};
  std::istringstream fields(line.substr(name_end + 1));
  std::string field;
  for (int i = 3; i <= 22; ++i) fields >> field;
  return field;
}

/// Machine, its run, and its view of processes: in a container it is its own.
std::string machine() {
  std::error_code error;
  const std::string processes = fs::read_symlink("/proc/self/ns/pid", error).string();
  return sha256(host_name() + " " + first_line("/proc/sys/kernel/random/boot_id") + " " + processes).substr(0, 12);
}

}  // namespace

std::string host_name() {
  char name[256] = {};
  if (::gethostname(name, sizeof name - 1) != 0 || name[0] == '\0') return "unknown";
  return name;
}

std::string worker_name(const std::string& key) {
  const std::string process = std::to_string(::getpid());
  return fmt::format("{}.{}.{}.{}.{}", key, machine(), process, began(process), random_name());
}

bool lives(const fs::path& worker, fs::file_time_type now) {
  constexpr auto kPatience = std::chrono::seconds(60);  // twelve times what a worker leaves between two touches
  std::istringstream name(worker.filename());
  std::string part[4];  // key, machine, process, when it began
  for (std::string& text : part) std::getline(name, text, '.');
  if (part[1] == machine()) return !part[3].empty() && began(part[2]) == part[3];
  std::error_code error;
  const auto at = fs::last_write_time(worker, error);
  return !error && now - at < kPatience;
}

fs::file_time_type now_in(const fs::path& folder) {
  std::error_code error;
  const fs::path touched = folder / fmt::format(".{}", random_name());
  auto now = fs::file_time_type::clock::now();
  if (std::ofstream(touched) << 'x') {
    const auto there = fs::last_write_time(touched, error);
    if (!error) now = there;
  }
  fs::remove(touched, error);
  return now;
}

/// Lines are sorted: a search by halves, in bytes.
Result<ArchiveTask> find_task(const fs::path& out, const std::string& key) {
  const fs::path path = out / kTasks;
  std::ifstream file(path, std::ios::binary);
  if (!file)
    return Error{ErrorCode::kNotFound,
                 fmt::format("cannot read '{}': there is no such file; duoptic batch run makes it", path.string())};
  file.seekg(0, std::ios::end);
  std::streamoff low = 0, high = file.tellg();  // the line begins in [low, high)
  std::string line;
  while (low < high) {
    const std::streamoff middle = low + (high - low) / 2;
    file.clear();
    file.seekg(middle == 0 ? 0 : middle - 1);
    if (middle > 0) std::getline(file, line);  // up to the line that begins at `middle` or after it
    const std::streamoff at = file.tellg();
    if (at < 0 || at >= high || !std::getline(file, line)) {
      high = middle;
      continue;
    }
    const std::string_view found = std::string_view(line).substr(0, kKeyLetters);
    if (found == key) {
      DUO_TRY_ASSIGN(ArchiveTask task,
                     task_from(nlohmann::json::parse(line.substr(found.size()), nullptr, false), path.string()));
      task.key = key;
      return task;
    }
    if (found < key)
      low = at + static_cast<std::streamoff>(line.size()) + 1;
    else
      high = middle;
  }
  return ArchiveTask{};
}

}  // namespace duo
