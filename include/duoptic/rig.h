// A rig: two cameras fixed to each other. What calibration produces and a rig file holds.
#pragma once

#include <array>
#include <filesystem>
#include <string>
#include <string_view>

#include "duoptic/geometry.h"
#include "duoptic/image.h"
#include "duoptic/result.h"

namespace duo {

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

struct Rig {
  Camera left, right;
  Rigid3 right_from_left;  // p_in_right = right_from_left * p_in_left
  double reprojection_rms_px = 0;  // how well the calibration fitted; 0 = unknown
  double baseline_m() const { return norm(right_from_left.t_m); }
};

/// The pair after row alignment: both cameras share one focal length and principal point.
struct Rectified {
  Size size;
  double focal_px = 0, cx_px = 0, cy_px = 0, baseline_m = 0;
  Mat3 rig_from_left;    // rotation from the raw left camera's axes to the rig frame's
  Mat3 rig_from_right;   // likewise for the right camera; the rig frame's origin is the left camera's centre
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
/// orthonormal with determinant +1, baseline outside 1 cm .. 5 m, left and right swapped.
Result<void> check_rig(const Rig& rig, const std::string& name);

/// Writes our JSON (schema "duoptic.rig", version 1).
Result<void> save_rig(const Rig& rig, const std::filesystem::path& path);

}  // namespace duo
