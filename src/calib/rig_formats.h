// The formats of rig files. Each reader only translates; check_rig() judges the numbers.
#pragma once

#include <fmt/format.h>

#include <array>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>
#include <utility>

#include "duoptic/rig.h"

namespace YAML {
class Node;
}

namespace duo {

/// The error of all rig readers: "cannot use rig 'name': why".
template <class... Args>
Error rig_error(const std::string& name, fmt::format_string<Args...> format, Args&&... args) {
  return {ErrorCode::kBadInput, fmt::format("cannot use rig '{}': {}", name, fmt::format(format, std::forward<Args>(args)...))};
}

/// Far above any rig (2 to 4 kB), low enough that no parser can be kept busy or made to recurse without end.
inline constexpr std::size_t kMaxRigBytes = 1 << 20;

/// The text without leading spaces and byte order mark.
///
/// Errors  nothing in it; longer than kMaxRigBytes; nested deeper than any rig file
Result<std::string_view> rig_text(std::string_view text, const std::string& name);

/// Our own JSON, schema "duoptic.rig".
Result<Rig> rig_from_json(const nlohmann::json& json, const std::string& name);

/// What OpenCV's FileStorage writes as JSON or as YAML.
Result<Rig> rig_from_opencv_json(const nlohmann::json& json, const std::string& name);
Result<Rig> rig_from_opencv_yaml(const YAML::Node& map, const std::string& name);

/// Any of the YAML formats, told apart by their keys.
Result<Rig> rig_from_yaml(std::string_view text, const std::string& name);

/// Kalibr's camchain: pinhole cameras with radtan distortion. Kalibr has four coefficients; a rig's others stand beside them
/// under a key of ours, which Kalibr passes over, so that a rig comes back as it was.
Result<Rig> rig_from_kalibr(const YAML::Node& map, const std::string& name);
/// `four`: the radtan coefficients of either camera, see radtan_of().
std::string kalibr_from_rig(const Rig& rig, const std::array<std::array<double, 4>, 2>& four);

/// ROS camera_info: a file, message or YAML document a camera.
bool is_ros_camera(const YAML::Node& map);
Result<Rig> rig_from_ros(const YAML::Node& left, const YAML::Node& right, const std::string& name);
Result<Rig> rig_from_ros_texts(std::string_view left, std::string_view right, const std::string& left_name,
                               const std::string& right_name);
std::string ros_from_camera(const Camera& camera, const std::string& camera_name, const Mat3& rectified_from_camera,
                            const std::array<double, 12>& projection);

}  // namespace duo
