#include "duoptic/rig.h"

#include <algorithm>
#include <array>
#include <ctime>
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

/// What the first bytes of files say that are no text.
std::string_view kind_of_bytes(std::string_view bytes) {
  if (bytes.starts_with("PK\x03\x04")) return "a .zip, as NumPy's .npz is";
  if (bytes.starts_with("\x93NUMPY")) return "NumPy's .npy";
  if (bytes.starts_with("\x1F\x8B")) return "compressed by gzip";
  if (bytes.starts_with("MATLAB")) return "MATLAB's .mat";
  if (bytes.starts_with(std::string_view("\x80", 1))) return "a Python pickle";
  return {};
}

}  // namespace

std::string date_now() {
  const std::time_t now = std::time(nullptr);
  std::tm utc{};
  gmtime_r(&now, &utc);
  std::array<char, 32> text{};
  std::strftime(text.data(), text.size(), "%Y-%m-%dT%H:%M:%SZ", &utc);
  return text.data();
}

Result<std::string_view> rig_text(std::string_view text, const std::string& name) {
  if (const std::string_view kind = kind_of_bytes(text); !kind.empty())
    return rig_error(name, "this is {}, which is not read; write the calibration as text, with OpenCV's FileStorage for one",
                     kind);
  const std::size_t start = text.find_first_not_of(" \t\r\n\xEF\xBB\xBF");  // spaces and a byte order mark
  if (start == text.npos) return rig_error(name, "the file is empty; give a calibration of both cameras");
  text.remove_prefix(start);
  if (text.size() > kMaxRigBytes || bracket_depth(text) > kMaxDepth)
    return rig_error(name, "this is no rig file (larger than 1 MiB or nested deeper than {} levels)", kMaxDepth);
  return text;
}

Result<Rig> translate_rig(std::string_view text, const std::string& name, Size size) {
  DUO_TRY_ASSIGN(text, rig_text(text, name));
  if (is_rig_of_lines(text)) return rig_from_lines(text, name, size);
  if (text.front() != '{' && text.front() != '<') return rig_from_yaml(text, name, size);
  if (text.front() == '{') {
    const auto json = nlohmann::json::parse(text, nullptr, /*allow_exceptions=*/false);
    if (!json.is_discarded() && json.contains("schema")) return rig_from_json(json, name);
  }
  DUO_TRY_ASSIGN(const OpencvNumbers numbers, opencv_numbers(text, name));
  return rig_from_opencv(numbers, name, size);
}

Result<Rig> parse_rig(std::string_view text, const std::string& name) {
  DUO_TRY_ASSIGN(Rig rig, translate_rig(text, name, {}));
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
