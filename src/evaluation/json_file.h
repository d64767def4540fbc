// A JSON file of others.
#pragma once

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "core/file.h"

namespace duo {

/// Errors  those of read_file(), with 256 MiB; no JSON
inline Result<nlohmann::json> read_json(const std::filesystem::path& path) {
  constexpr std::size_t kMostBytes = std::size_t{256} << 20;
  DUO_TRY_ASSIGN(const std::string text, read_file(path, kMostBytes, "JSON file"));
  nlohmann::json json = nlohmann::json::parse(text, nullptr, false);
  if (json.is_discarded()) return Error{ErrorCode::kBadInput, fmt::format("cannot use {}: it is no JSON", path.string())};
  return json;
}

}  // namespace duo
