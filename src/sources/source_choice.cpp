#include "duoptic/source_choice.h"

#include <fmt/format.h>

#include <algorithm>
#include <sstream>
#include <system_error>

#include "core/cache_file.h"
#include "core/file.h"

namespace duo {
namespace {

constexpr std::size_t kMostRecentBytes = 1 << 16;

bool is_rig_file(const std::filesystem::path& file) {
  const std::string ending = file.extension();
  return ending == ".json" || ending == ".yml" || ending == ".yaml" || ending == ".xml";
}

bool names(const std::filesystem::path& file, const char* side) {
  return file.filename().string().find(side) != std::string::npos;
}

/// Cameras and streams have no files.
bool is_gone(const std::string& name) {
  std::error_code error;
  return name.starts_with('/') && !std::filesystem::exists(name, error);
}

std::string absolute(const std::string& name) {
  std::error_code error;
  return !name.empty() && std::filesystem::exists(name, error) ? std::filesystem::absolute(name, error).string() : name;
}

}  // namespace

Result<SourceChoice> choose_files(std::vector<std::filesystem::path> files) {
  const auto rigs = std::stable_partition(files.begin(), files.end(), [](const auto& file) { return !is_rig_file(file); });
  if (files.end() - rigs > 1 || rigs - files.begin() > 2)
    return Error{ErrorCode::kBadInput,
                 "cannot choose among these files; give a left and a right one, or one with both views, and "
                 "perhaps a rig"};
  SourceChoice out;
  if (rigs != files.end()) out.rig = rigs->string();
  files.erase(rigs, files.end());
  std::sort(files.begin(), files.end());
  if (files.size() == 2 && (names(files[1], "left") || names(files[0], "right")) && !names(files[0], "left"))
    std::swap(files[0], files[1]);
  if (!files.empty()) out.left = files[0].string();
  if (files.size() == 2) out.right = files[1].string();
  return out;
}

std::vector<SourceChoice> recent_sources() {
  std::vector<SourceChoice> out;
  const auto text = read_file(cache_file("recent"), kMostRecentBytes, "list of recent sources");
  if (!text) return out;
  std::istringstream lines(*text);
  for (std::string line; std::getline(lines, line) && out.size() < kMostRecent;) {
    std::istringstream fields(line);
    SourceChoice choice;
    std::getline(fields, choice.left, '\t');
    std::getline(fields, choice.right, '\t');
    std::getline(fields, choice.rig, '\t');
    if (!choice.left.empty() && !is_gone(choice.left) && !is_gone(choice.right) && !is_gone(choice.rig)) out.push_back(choice);
  }
  return out;
}

void remember_source(SourceChoice choice) {
  choice = {absolute(choice.left), absolute(choice.right), absolute(choice.rig)};
  if ((choice.left + choice.right + choice.rig).find_first_of("\t\n") != std::string::npos) return;
  std::vector<SourceChoice> all = recent_sources();
  std::erase(all, choice);
  all.insert(all.begin(), choice);
  std::string text;
  for (const SourceChoice& c : all) text += fmt::format("{}\t{}\t{}\n", c.left, c.right, c.rig);
  write_cache_file(cache_file("recent"), text);
}

}  // namespace duo
