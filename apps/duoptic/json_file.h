// A JSON file of others.
#pragma once

#include <fmt/format.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "duoptic/result.h"

namespace duo::app {

/// Errors  no file, more than 256 MiB, no JSON
inline Result<nlohmann::json> read_json(const std::filesystem::path& path) {
  constexpr std::uintmax_t kMostBytes = std::uintmax_t{256} << 20;
  std::error_code error;
  if (!std::filesystem::is_regular_file(path, error))
    return Error{ErrorCode::kNotFound, fmt::format("cannot read {}: there is no such file", path.string())};
  if (std::filesystem::file_size(path, error) > kMostBytes)
    return Error{ErrorCode::kBadInput, fmt::format("cannot read {}: it has more than 256 MiB", path.string())};
  std::ifstream file(path);
  nlohmann::json json = nlohmann::json::parse(file, nullptr, false);
  if (json.is_discarded()) return Error{ErrorCode::kBadInput, fmt::format("cannot use {}: it is no JSON", path.string())};
  return json;
}

}  // namespace duo::app
