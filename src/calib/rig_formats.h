// The formats of rig files. Each reader only translates; check_rig() judges the numbers.
#pragma once

#include <fmt/format.h>

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>
#include <utility>

#include "duoptic/rig.h"

namespace duo {

/// The error of all rig readers: "cannot use rig 'name': why".
template <class... Args>
Error rig_error(const std::string& name, fmt::format_string<Args...> format, Args&&... args) {
  return {ErrorCode::kBadInput, fmt::format("cannot use rig '{}': {}", name, fmt::format(format, std::forward<Args>(args)...))};
}

/// Our own JSON, schema "duoptic.rig".
Result<Rig> rig_from_json(const nlohmann::json& json, const std::string& name);
std::string json_from_rig(const Rig& rig);

/// What OpenCV's FileStorage writes as JSON or as YAML.
Result<Rig> rig_from_opencv_json(const nlohmann::json& json, const std::string& name);
Result<Rig> rig_from_opencv_yaml(std::string_view text, const std::string& name);

}  // namespace duo
