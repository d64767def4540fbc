#include "duoptic/rig.h"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "calib/rig_formats.h"
#include "core/file.h"

namespace duo {
namespace {

constexpr int kMaxDepth = 64;

/// Depth of brackets, strings not told apart: a rig file has no brackets in strings.
int bracket_depth(std::string_view text) {
  int depth = 0, deepest = 0;
  for (const char c : text) {
    if (c == '[' || c == '{') deepest = std::max(deepest, ++depth);
    if (c == ']' || c == '}') --depth;
  }
  return deepest;
}

Result<Rig> translate(std::string_view text, const std::string& name) {
  DUO_TRY_ASSIGN(text, rig_text(text, name));
  if (text.front() == '<') return rig_error(name, "XML is not read; save the calibration as .yml or .json");
  if (text.front() != '{') return rig_from_yaml(text, name);

  const auto json = nlohmann::json::parse(text, nullptr, /*allow_exceptions=*/false);
  if (json.is_discarded()) return rig_error(name, "the JSON is broken or cut short; write the file again");
  return json.contains("schema") ? rig_from_json(json, name) : rig_from_opencv_json(json, name);
}

}  // namespace

Result<std::string_view> rig_text(std::string_view text, const std::string& name) {
  const std::size_t start = text.find_first_not_of(" \t\r\n\xEF\xBB\xBF");  // spaces and a byte order mark
  if (start == text.npos) return rig_error(name, "the file is empty; give a calibration of both cameras");
  text.remove_prefix(start);
  if (text.size() > kMaxRigBytes || bracket_depth(text) > kMaxDepth)
    return rig_error(name, "this is no rig file (larger than 1 MiB or nested deeper than {} levels)", kMaxDepth);
  return text;
}

Result<Rig> parse_rig(std::string_view text, const std::string& name) {
  DUO_TRY_ASSIGN(Rig rig, translate(text, name));
  DUO_TRY(check_rig(rig, name));
  return rig;
}

Result<Rig> load_rig(const std::filesystem::path& path) {
  DUO_TRY_ASSIGN(const std::string text, read_file(path, kMaxRigBytes, "rig"));
  return parse_rig(text, path.string());
}

Result<void> save_rig(const Rig& rig, const std::filesystem::path& path) {
  DUO_TRY(check_rig(rig, path.string()));
  return write_file(path, json_from_rig(rig));
}

}  // namespace duo
