// A rig: two cameras fixed to each other. What calibration produces and a rig file holds.
#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include "duoptic/geometry.h"
#include "duoptic/image.h"
#include "duoptic/result.h"

namespace [[gnu::visibility("default")]] duo {

/// A pinhole camera with radial and tangential distortion.
///
/// Units   pixels; the centre of the top-left pixel is (0, 0)
/// Source  Brown, "Decentering distortion of lenses", 1966; coefficients in OpenCV's order
///         k1 k2 p1 p2 k3 k4 k5 k6 (k4..k6: rational denominator; 0 when absent)
struct Camera {
  Size size;
  double fx_px = 0, fy_px = 0, cx_px = 0, cy_px = 0;
  std::array<double, 8> distortion = {};
  friend bool operator==(const Camera&, const Camera&) = default;
};

/// How far what was seen lies from what the rig predicts, root mean square over the corners of a board or the matches of a
/// scene. Reprojection: distance from the seen place to the predicted one. Row: difference of y in the rectified pair.
///
/// Units   px; 0 = unknown
struct RigErrors {
  double left_px = 0, right_px = 0;  // reprojection, each camera
  double row_px = 0;
  double held_out_px = 0, held_out_row_px = 0;  // both, of views that the calibration had not seen
  friend bool operator==(const RigErrors&, const RigErrors&) = default;
};

/// The distances at which a rig's depth is judged.
inline constexpr std::array<double, 3> kJudgedDepths_m = {1, 1.5, 2};

/// One standard deviation of what a calibration found.
struct RigUncertainty {
  double left_focal_px = 0, right_focal_px = 0;
  double tilt_rad = 0, pan_rad = 0, roll_rad = 0;  // of the right camera to the left, around x, y, z
  double baseline_m = 0;
  std::array<double, 3> depth_m = {};  // of a point in the middle of the view, at kJudgedDepths_m
  friend bool operator==(const RigUncertainty&, const RigUncertainty&) = default;
};

struct Rig {
  Camera left, right;
  Rigid3 right_from_left;          // p_in_right = right_from_left * p_in_left
  double reprojection_rms_px = 0;  // how well the calibration fitted, both cameras together; 0 = unknown
  RigErrors errors = {};
  std::optional<RigUncertainty> uncertainty = {};
  bool metric = true;                           // false: the length of the baseline is a guess, and so is every distance
  double time_offset_s = 0;                     // a right picture was taken this much later than the left one of its pair
  std::string left_name = {}, right_name = {};  // of the cameras, as their user knows them; may be empty
  std::string date = {};                        // of the calibration, ISO 8601 in UTC, like 2026-03-01T12:00:00Z; may be empty
  double baseline_m() const { return norm(right_from_left.t_m); }
};

/// Now, as Rig::date has it.
std::string date_now();

/// A camera without distortion, and its like `baseline_m` to the right of it.
///
/// Units   pixels of the left picture, the centre of the top-left one is (0, 0); metres, z along the axis
struct Pinhole {
  double focal_px = 0, cx_px = 0, cy_px = 0, baseline_m = 0;

  /// Where a point is seen; z > 0.
  Vec2 project(Vec3 p_m) const { return {cx_px + focal_px * p_m.x / p_m.z, cy_px + focal_px * p_m.y / p_m.z}; }
  /// The point that is seen there at this depth.
  Vec3 unproject(Vec2 at_px, double z_m) const {
    return {(at_px.x - cx_px) / focal_px * z_m, (at_px.y - cy_px) / focal_px * z_m, z_m};
  }
  /// The point that is seen there with this disparity, above 0.
  Vec3 triangulate(Vec2 at_px, double d_px) const {
    const double per_px_m = baseline_m / d_px;
    return {(at_px.x - cx_px) * per_px_m, (at_px.y - cy_px) * per_px_m, focal_px * per_px_m};
  }
  double depth_m(double d_px) const { return focal_px * baseline_m / d_px; }
  double disparity_px(double z_m) const { return focal_px * baseline_m / z_m; }
};

/// The pair after row alignment: both cameras share one focal length and principal point. The pinhole's points are in the rig
/// frame.
struct Rectified : Pinhole {
  Size size;
  Mat3 rig_from_left;   // rotation from the raw left camera's axes to the rig frame's
  Mat3 rig_from_right;  // likewise for the right camera; the rig frame's origin is the left camera's centre
};

/// Reads a rig: our JSON, or OpenCV's YAML / JSON in any of these spellings:
/// cameraMatrix1 distCoeffs1 cameraMatrix2 distCoeffs2 R T · M1 D1 M2 D2 R T · camera_matrix_left dist_coeffs_left
/// camera_matrix_right dist_coeffs_right R T; with image_width and image_height (or image_size); T in metres.
///
/// Errors  one line: missing, truncated, unknown format, missing key; then everything check_rig() refuses
Result<Rig> load_rig(const std::filesystem::path& path);

/// The same for text already in memory; `name` stands for it in messages.
Result<Rig> parse_rig(std::string_view text, const std::string& name);

/// Refuses what cannot be a rig: non-finite numbers, focal lengths or centres that do not fit the size, rotation not
/// orthonormal with determinant +1, baseline outside 1 cm .. 5 m, left and right swapped, errors below zero.
Result<void> check_rig(const Rig& rig, const std::string& name);

/// Writes our JSON (schema "duoptic.rig", version 1). What came after the first release of version 1 (errors, uncertainty,
/// metric, time_offset_s, names, date) may be missing in a file.
Result<void> save_rig(const Rig& rig, const std::filesystem::path& path);
/// The text that save_rig() writes.
std::string json_from_rig(const Rig& rig);

}  // namespace duo
