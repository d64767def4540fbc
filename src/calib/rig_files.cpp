#include "duoptic/rig_files.h"

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <system_error>
#include <utility>
#include <vector>

#include "calib/normal_equations.h"
#include "calib/opencv_rectified.h"
#include "calib/rectification.h"
#include "calib/rig_formats.h"
#include "calib/yaml_reader.h"
#include "core/file.h"
#include "core/lens.h"

namespace duo {
namespace {

namespace fs = std::filesystem;

bool is_yaml(const fs::path& path) { return path.extension() == ".yml" || path.extension() == ".yaml"; }

// --- ROS ------------------------------------------------------------------------------------------------------------------

std::string name_or(const std::string& known, const char* side) { return known.empty() ? side : known; }

Result<RigExport> write_camera_infos(const std::string& left, const std::string& right, const fs::path& path) {
  if (is_yaml(path)) {
    DUO_TRY(write_file(path, left + "---\n" + right));
    return RigExport{{path}};
  }
  std::error_code error;
  fs::create_directories(path, error);
  if (error) return Error{ErrorCode::kWriteFailed, fmt::format("cannot write to {}: {}", path.string(), error.message())};
  DUO_TRY(write_file(path / "left.yaml", left));
  DUO_TRY(write_file(path / "right.yaml", right));
  return RigExport{{path / "left.yaml", path / "right.yaml"}};
}

Result<RigExport> write_ros(const Rig& rig, const fs::path& path) {
  const OpencvRectified rectified = opencv_rectified(rig);
  return write_camera_infos(ros_from_camera(rig.left, name_or(rig.left_name, "left"), rectified.r1, rectified.p1),
                            ros_from_camera(rig.right, name_or(rig.right_name, "right"), rectified.r2, rectified.p2), path);
}

/// Of the pictures that depth is of: nothing is left to undo, and the right one looks from a baseline to the right.
Result<RigExport> write_ros_rectified(const Rig& rig, const fs::path& path) {
  DUO_TRY_ASSIGN(const Rectified r, rectified_geometry(rig, path.string()));
  const Camera camera = {.size = r.size, .fx_px = r.focal_px, .fy_px = r.focal_px, .cx_px = r.cx_px, .cy_px = r.cy_px};
  const auto projection = [&](double x_m) {
    return std::array{r.focal_px, 0.0, r.cx_px, -r.focal_px * x_m, 0.0, r.focal_px, r.cy_px, 0.0, 0.0, 0.0, 1.0, 0.0};
  };
  return write_camera_infos(ros_from_camera(camera, name_or(rig.left_name, "left"), Mat3{}, projection(0)),
                            ros_from_camera(camera, name_or(rig.right_name, "right"), Mat3{}, projection(r.baseline_m)), path);
}

// --- Kalibr ---------------------------------------------------------------------------------------------------------------

struct Radtan {
  std::array<double, 4> k;
  double worst_px;
};

/// The four coefficients that come nearest to a lens over its picture: the model is linear in them.
Radtan radtan_of(const Camera& camera) {
  constexpr int kSteps = 40;
  const auto& d = camera.distortion;
  if (d[4] == 0 && !has_denominator(camera)) return {{d[0], d[1], d[2], d[3]}, 0};
  const Lens lens(camera);
  std::vector<std::pair<Eigen::Vector4d, double>> rows;  // of the equations, and their right sides
  Eigen::Matrix4d information = Eigen::Matrix4d::Zero();
  Eigen::Vector4d pull = Eigen::Vector4d::Zero();
  const auto add = [&](const Eigen::Vector4d& row, double right) {
    rows.emplace_back(row, right);
    information += row * row.transpose();
    pull += right * row;
  };
  for (int i = 0; i <= kSteps; ++i)
    for (int j = 0; j <= kSteps; ++j) {
      const Vec2 pixel = {(camera.size.width - 1.0) * j / kSteps, (camera.size.height - 1.0) * i / kSteps};
      const auto ray = lens.ray_of(pixel);
      if (!ray) continue;
      const double x = ray->x, y = ray->y, r2 = x * x + y * y;
      add({x * r2, x * r2 * r2, 2 * x * y, r2 + 2 * x * x}, (pixel.x - camera.cx_px) / camera.fx_px - x);
      add({y * r2, y * r2 * r2, r2 + 2 * y * y, 2 * x * y}, (pixel.y - camera.cy_px) / camera.fy_px - y);
    }
  const Eigen::Vector4d k = solve_normal(information, pull);
  double worst = 0;
  for (const auto& [row, right] : rows) worst = std::max(worst, std::abs(row.dot(k) - right));
  return {{k[0], k[1], k[2], k[3]}, worst * std::max(camera.fx_px, camera.fy_px)};
}

Result<RigExport> write_kalibr(const Rig& rig, const fs::path& path) {
  const Radtan left = radtan_of(rig.left), right = radtan_of(rig.right);
  DUO_TRY(write_file(path, kalibr_from_rig(rig, {left.k, right.k})));
  return RigExport{{path}, std::max(left.worst_px, right.worst_px)};
}

Error wrong_ending(const fs::path& path, const char* what) {
  return {ErrorCode::kBadInput, fmt::format("cannot export to '{}': {}", path.string(), what)};
}

}  // namespace

Result<RigImport> import_rig(const fs::path& file, const fs::path& right, Size size) {
  std::error_code ignored;
  const bool folder = right.empty() && fs::is_directory(file, ignored);
  const fs::path first = folder ? file / "left.yaml" : file, second = folder ? file / "right.yaml" : right;
  DUO_TRY_ASSIGN(const std::string text, read_file(first, kMaxRigBytes, "rig"));
  RigImport read;
  if (second.empty()) {
    DUO_TRY_ASSIGN(read.rig, translate_rig(text, first.string(), size));
  } else {
    DUO_TRY_ASSIGN(const std::string more, read_file(second, kMaxRigBytes, "rig"));
    DUO_TRY_ASSIGN(read, rig_from_two_texts(text, more, first.string(), second.string(), size));
  }
  DUO_TRY(check_rig(read.rig, file.string()));
  return read;
}

Result<RigExport> export_rig(const Rig& rig, RigFormat format, const fs::path& path) {
  DUO_TRY(check_rig(rig, path.string()));
  if (!rig.metric)
    return rig_error(path.string(),
                     "it is not metric, and other programs' files cannot say so; calibrate with a board or give "
                     "intrinsics and baseline to --from-scene");
  try {
    switch (format) {
      case RigFormat::kOpencv:
        if (!is_yaml(path) && path.extension() != ".json")
          return wrong_ending(path, "OpenCV's files end with .yml, .yaml or .json");
        DUO_TRY(write_file(path, opencv_text(rig, opencv_rectified(rig), is_yaml(path))));
        return RigExport{{path}};
      case RigFormat::kRos:
        return write_ros(rig, path);
      case RigFormat::kRosRectified:
        return write_ros_rectified(rig, path);
      case RigFormat::kKalibr:
        if (!is_yaml(path)) return wrong_ending(path, "Kalibr's files end with .yaml or .yml");
        return write_kalibr(rig, path);
    }
  } catch (const std::exception& e) {  // OpenCV's
    return rig_error(path.string(), "OpenCV cannot rectify it ({})", e.what());
  }
  return wrong_ending(path, "unknown format");
}

}  // namespace duo
