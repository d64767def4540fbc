// Rig files of other programs, read and written: docs/rig_files.md has every field.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "duoptic/rig.h"

namespace [[gnu::visibility("default")]] duo {

enum class RigFormat : std::uint8_t {
  kOpencv,        // M1 D1 M2 D2 R T R1 R2 P1 P2 Q, YAML or JSON
  kRos,           // a camera_info YAML of each camera
  kKalibr,        // camchain.yaml, pinhole-radtan
  kRosRectified,  // camera_info of the rectified pictures, which disparity, depth and left_rectified.png are
};

struct RigImport {
  Rig rig;
  std::string note;  // what was assumed and may be wrong; empty: nothing
};

/// Reads a rig from all that load_rig() reads, from a folder that holds ROS's left.yaml and right.yaml, or from two files:
/// ROS's camera_info of either camera, or OpenCV's intrinsics and extrinsics. `size`: of the pictures, for files that do not
/// say it or hold calibrations of several sizes; empty: not known.
///
/// Errors  those of load_rig(); two files that are no such pair; `size` is needed
Result<RigImport> import_rig(const std::filesystem::path& file, const std::filesystem::path& right = {}, Size size = {});

struct RigExport {
  std::vector<std::filesystem::path> files;
  double lens_error_px =
      0;  // how far at most the format's lens lies from the rig's, inside the picture; only Kalibr's can differ
};

/// Writes a rig for another program. kOpencv: .yml, .yaml or .json says which. kRos: a .yml or .yaml holds both cameras, one
/// document each; any other path is a folder that gets left.yaml and right.yaml, as ROS wants them. kRosRectified: the same.
///
/// Errors  not a format for this ending; a rig that is not metric; those of check_rig() and of writing
Result<RigExport> export_rig(const Rig& rig, RigFormat format, const std::filesystem::path& path);

}  // namespace duo
