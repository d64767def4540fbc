// What structured light keeps in files: which patterns were shown, and what the cameras saw of them.
#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <system_error>

#include "core/json_text.h"
#include "duoptic/structured_light.h"
#include "evaluation/json_file.h"

namespace duo {
namespace {

namespace fs = std::filesystem;

constexpr const char* kPictureEndings[] = {".png", ".jpg", ".jpeg", ".bmp", ".tif", ".tiff", ".webp", ".ppm", ".pgm"};

std::string stem_of(bool is_left, std::size_t pattern) { return fmt::format("{}_{:03}", is_left ? "left" : "right", pattern); }

/// Empty where there is none.
fs::path find_picture(const fs::path& folder, bool is_left, std::size_t pattern) {
  std::error_code ignored;
  for (const char* ending : kPictureEndings)
    if (fs::path path = folder / (stem_of(is_left, pattern) + ending); fs::is_regular_file(path, ignored)) return path;
  return {};
}

}  // namespace

std::string light_file_name(bool is_left, std::size_t pattern) { return stem_of(is_left, pattern) + ".png"; }

Result<std::vector<LightFiles>> find_light_files(const fs::path& folder, const LightCode& code) {
  DUO_TRY(check_light_code(code));
  const auto refused = [&](ErrorCode kind, const std::string& why) {
    return Error{kind, fmt::format("cannot decode {}: {}", folder.string(), why)};
  };
  std::error_code error;
  if (!fs::is_directory(folder, error)) return refused(ErrorCode::kNotFound, error ? error.message() : "it is no folder");
  const std::vector<LightPattern> patterns = light_patterns(code);
  std::vector<LightFiles> out;
  for (std::size_t i = 0; i < patterns.size(); ++i) {
    out.push_back({find_picture(folder, true, i), find_picture(folder, false, i)});
    if (out.back().left.empty() || out.back().right.empty())
      return refused(ErrorCode::kBadInput, fmt::format("{} is missing, of pattern {} of 0 .. {} ({}); record all again",
                                                       light_file_name(out.back().left.empty(), i), i, patterns.size() - 1,
                                                       describe_pattern(code, patterns[i])));
  }
  if (const fs::path more = find_picture(folder, true, patterns.size()); !more.empty())
    return refused(
        ErrorCode::kBadInput,
        fmt::format("{} is there, but patterns of {}x{} with a period of {} px are numbered 0 .. {}; other patterns "
                    "were shown than patterns.json says",
                    more.filename().string(), code.screen.width, code.screen.height, code.period_px, patterns.size() - 1));
  return out;
}

Result<LightCode> load_light_code(const std::filesystem::path& path) {
  DUO_TRY_ASSIGN(const nlohmann::json json, read_json(path));
  const auto whole = [](const nlohmann::json& value) { return value.is_number_integer() ? value.get<std::int64_t>() : 0; };
  const auto side = [](std::int64_t value) { return static_cast<int>(std::clamp<std::int64_t>(value, 0, 1 << 20)); };
  if (!json.is_object() || json.value("schema", nlohmann::json()) != "duoptic.patterns" || !json.contains("screen") ||
      !json["screen"].is_array() || json["screen"].size() != 2 || !json.contains("period_px"))
    return Error{
        ErrorCode::kBadInput,
        fmt::format("cannot use {}: it must be the patterns.json that duoptic truth patterns or record wrote", path.string())};
  const LightCode code{{side(whole(json["screen"][0])), side(whole(json["screen"][1]))}, side(whole(json["period_px"]))};
  if (const auto checked = check_light_code(code); !checked)
    return Error{ErrorCode::kBadInput, fmt::format("{}: {}", path.string(), checked.error().what)};
  return code;
}

std::string json_from_light_code(const LightCode& code) {
  const nlohmann::ordered_json out = {{"schema", "duoptic.patterns"},
                                      {"version", 1},
                                      {"screen", {code.screen.width, code.screen.height}},
                                      {"period_px", code.period_px}};
  return json_text(out) + "\n";
}

}  // namespace duo
