// ROS camera_info: one file or message a camera; the pose is hidden in the rectification and projection matrices.
//
// Source  sensor_msgs/CameraInfo and camera_calibration_parsers of ROS: P = [f 0 cx Tx; 0 f cy Ty; 0 0 1 0] of the right camera
//         has Tx = -f * baseline; R turns the raw camera's axes into those of the rectified pair
#include <fmt/ranges.h>

#include <algorithm>
#include <span>

#include "calib/opencv_rectified.h"
#include "calib/rig_formats.h"
#include "calib/yaml_reader.h"

namespace duo {
namespace {

constexpr std::string_view kFiveModel = "plumb_bob", kEightModel = "rational_polynomial";

/// One camera's file as it stands.
struct CameraInfo {
  Camera camera;
  std::string name;
  Mat3 rectified_from_camera;
  std::array<double, 12> projection = {};  // row by row
};

/// What a message says of pictures, of `size`, that are not the whole sensor's; empty: nothing.
std::string part_of_sensor(const YAML::Node& map, const std::array<double, 2>& size) {
  const auto number = [](const YAML::Node& node) {
    double value = 0;
    return node.IsDefined() && YAML::convert<double>::decode(node, value) ? value : 0;
  };
  if (number(map["binning_x"]) > 1 || number(map["binning_y"]) > 1) return "binned";
  const YAML::Node roi = map["roi"];
  if (!roi.IsDefined() || !roi.IsMap()) return {};
  const auto part = [&](const char* key, double whole) { return number(roi[key]) != 0 && number(roi[key]) != whole; };
  const bool moved = number(roi["x_offset"]) != 0 || number(roi["y_offset"]) != 0;
  return moved || part("width", size[0]) || part("height", size[1]) ? "of a part of the sensor (roi)" : "";
}

// Files and messages spell their keys differently: camera_matrix, K (ROS 1), k (ROS 2).
Result<CameraInfo> read(const YAML::Node& map, const char* side, const std::string& name) {
  YamlReader reader(map, fmt::format("{} camera: ", side));
  const auto key = [&](std::initializer_list<const char*> spellings) {
    const std::string found = reader.key_of(spellings);
    return found.empty() ? std::string(*spellings.begin()) : found;
  };
  const auto width = reader.numbers(key({"image_width", "width"}), {1}, "it is the width of the pictures in px");
  const auto height = reader.numbers(key({"image_height", "height"}), {1}, "it is the height of the pictures in px");
  const auto k = reader.numbers(key({"camera_matrix", "K", "k"}), {9}, "a 3x3 camera matrix is needed");
  const auto d =
      reader.numbers(key({"distortion_coefficients", "D", "d"}), {0, 4, 5, 8, 12, 14}, "plumb_bob has 5 coefficients");
  const auto r = reader.numbers(key({"rectification_matrix", "R", "r"}), {9}, "calibrate both cameras together");
  const auto p = reader.numbers(key({"projection_matrix", "P", "p"}), {12}, "calibrate both cameras together");
  const std::string model = reader.text("distortion_model", "plumb_bob and rational_polynomial are read");
  const bool none = model.empty() && d.empty();  // a picture that comes rectified
  if (reader.wrong().empty() && !none && model != kFiveModel && model != kEightModel)
    reader.complain(fmt::format("distortion model '{}' is not read; plumb_bob and rational_polynomial are", model));
  if (!reader.wrong().empty()) return rig_error(name, "{}", reader.wrong());
  if (k[1] != 0 || k[3] != 0 || k[6] != 0 || k[7] != 0 || k[8] != 1)
    return rig_error(name, "{} camera: the camera matrix is not [fx 0 cx; 0 fy cy; 0 0 1]", side);

  if (const std::string part = part_of_sensor(map, {width[0], height[0]}); !part.empty())
    return rig_error(name, "{} camera: its pictures are {}; give a camera_info of whole pictures", side, part);

  CameraInfo info;
  info.camera = {.size = {reader.whole("image_width", width[0]), reader.whole("image_height", height[0])},
                 .fx_px = k[0],
                 .fy_px = k[4],
                 .cx_px = k[2],
                 .cy_px = k[5]};
  if (!reader.wrong().empty()) return rig_error(name, "{}", reader.wrong());
  if (const std::string wrong = put_coefficients(d, info.camera); !wrong.empty())
    return rig_error(name, "{} camera: the distortion {}", side, wrong);
  // Drivers of pictures that come rectified, and simulators, leave R empty: it turns nothing.
  if (std::any_of(r.begin(), r.end(), [](double value) { return value != 0; }))
    std::copy(r.begin(), r.end(), info.rectified_from_camera.m.begin());
  std::copy(p.begin(), p.end(), info.projection.begin());
  if (reader.key_of({"camera_name"}) == "camera_name") info.name = reader.text("camera_name", "");
  return info;
}

std::string matrix(const char* key, int rows, std::span<const double> data) {
  return fmt::format("{}:\n  rows: {}\n  cols: {}\n  data: [{}]\n", key, rows, data.size() / static_cast<std::size_t>(rows),
                     fmt::join(data, ", "));
}

}  // namespace

bool is_ros_camera(const YAML::Node& map) {
  return map["distortion_model"].IsDefined() &&
         (map["camera_matrix"].IsDefined() || map["K"].IsDefined() || map["k"].IsDefined());
}

namespace {

Result<Rig> rig_of(const CameraInfo& left, const CameraInfo& right, const std::string& name) {
  if (left.projection[3] != 0)
    return rig_error(name, "the first camera's projection matrix has a baseline ({}); give the left camera first",
                     left.projection[3]);
  const auto& p = right.projection;
  if (!(p[0] > 0 && p[5] > 0) || p[3] == 0)
    return rig_error(name,
                     "the right projection matrix has no baseline (its fourth number is -f * metres); calibrate both "
                     "cameras together");
  const Vec3 t_in_rectified_m = {p[3] / p[0], p[7] / p[5], p[11]};
  const Mat3 right_from_rectified = transposed(right.rectified_from_camera);
  Rig rig;
  rig.left = left.camera;
  rig.right = right.camera;
  rig.left_name = left.name;
  rig.right_name = right.name;
  rig.right_from_left = {right_from_rectified * left.rectified_from_camera, right_from_rectified * t_in_rectified_m};
  return rig;
}

}  // namespace

Result<Rig> rig_from_ros(const YAML::Node& left_map, const YAML::Node& right_map, const std::string& name) {
  try {
    DUO_TRY_ASSIGN(const CameraInfo left, read(left_map, "left", name));
    DUO_TRY_ASSIGN(const CameraInfo right, read(right_map, "right", name));
    return rig_of(left, right, name);
  } catch (const YAML::Exception& e) {  // nodes that look sound can still throw when they are asked for what they are not
    return rig_error(name, "the YAML is broken ({}); write the file again", e.msg);
  }
}

std::string ros_from_camera(const Camera& camera, const std::string& camera_name, const Mat3& rectified_from_camera,
                            const std::array<double, 12>& projection) {
  const std::size_t used = has_denominator(camera) ? 8 : 5;
  return fmt::format("image_width: {}\nimage_height: {}\ncamera_name: {}\n", camera.size.width, camera.size.height,
                     YAML::Dump(YAML::Node(camera_name))) +
         matrix("camera_matrix", 3,
                std::array{camera.fx_px, 0.0, camera.cx_px, 0.0, camera.fy_px, camera.cy_px, 0.0, 0.0, 1.0}) +
         fmt::format("distortion_model: {}\n", used == 8 ? kEightModel : kFiveModel) +
         matrix("distortion_coefficients", 1, std::span(camera.distortion).first(used)) +
         matrix("rectification_matrix", 3, rectified_from_camera.m) + matrix("projection_matrix", 3, projection);
}

}  // namespace duo
