// The formats of rig files. Each reader only translates; check_rig() judges the numbers.
#pragma once

#include <fmt/format.h>

#include <array>
#include <functional>
#include <map>
#include <nlohmann/json_fwd.hpp>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "duoptic/rig.h"
#include "duoptic/rig_files.h"

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

/// The rig in a text of any format, before check_rig().
///
/// Errors  of no known format; a file that needs `size` when that is empty
Result<Rig> translate_rig(std::string_view text, const std::string& name, Size size);

/// Our own JSON, schema "duoptic.rig".
Result<Rig> rig_from_json(const nlohmann::json& json, const std::string& name);

/// Of a file that OpenCV's FileStorage wrote, the lists of numbers that a rig is made of, by their keys.
using OpencvNumbers = std::map<std::string, std::vector<double>, std::less<>>;
/// `text`: JSON, YAML or XML, as rig_text() gives it.
///
/// Errors  broken; another lens model than Brown's
Result<OpencvNumbers> opencv_numbers(std::string_view text, const std::string& name);
/// `size`: of the calibrated pictures, for files that do not say it; empty: not known.
Result<Rig> rig_from_opencv(const OpencvNumbers& numbers, const std::string& name, Size size = {});
/// The usual sizes of pictures in whose middle both principal points lie.
std::vector<Size> likely_sizes(Vec2 left_centre_px, Vec2 right_centre_px);
std::vector<Size> likely_sizes(const OpencvNumbers& numbers);

/// Takes over up to eight coefficients in OpenCV's order; what is wrong with them, empty when nothing is. OpenCV writes 12 or
/// 14 also where the last are not used.
std::string put_coefficients(std::span<const double> numbers, Camera& camera);

/// Files of lines with a key and numbers: Middlebury's calib.txt, KITTI's calib_cam_to_cam.txt and calib.txt, ZED's SN*.conf.
///
/// Errors  `size` is needed and empty: which there are
bool is_rig_of_lines(std::string_view text);
Result<Rig> rig_from_lines(std::string_view text, const std::string& name, Size size = {});

/// The maps of a YAML file's documents; empty documents are left out.
///
/// Errors  broken; not a map
Result<std::vector<YAML::Node>> yaml_documents(std::string_view text, const std::string& name);

/// Any of the YAML formats, told apart by their keys.
Result<Rig> rig_from_yaml(std::string_view text, const std::string& name, Size size = {});

/// Kalibr's camchain: pinhole cameras with radtan distortion. Kalibr has four coefficients; a rig's others stand beside them
/// under a key of ours, which Kalibr passes over, so that a rig comes back as it was.
Result<Rig> rig_from_kalibr(const YAML::Node& map, const std::string& name);
/// `four`: the radtan coefficients of either camera, see radtan_of().
std::string kalibr_from_rig(const Rig& rig, const std::array<std::array<double, 4>, 2>& four);

/// ROS camera_info: a file, message or YAML document a camera.
bool is_ros_camera(const YAML::Node& map);
Result<Rig> rig_from_ros(const YAML::Node& left, const YAML::Node& right, const std::string& name);

/// ROS: a file a camera. OpenCV: the cameras in the first file, their pose in the second, as its sample stereo_calib writes
/// them, which does not say the pictures' size; `size` then, or the one usual size that likely_sizes() finds, with a note.
Result<RigImport> rig_from_two_texts(std::string_view first, std::string_view second, const std::string& first_name,
                                     const std::string& second_name, Size size = {});
std::string ros_from_camera(const Camera& camera, const std::string& camera_name, const Mat3& rectified_from_camera,
                            const std::array<double, 12>& projection);

}  // namespace duo
