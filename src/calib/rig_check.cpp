#include <algorithm>
#include <cmath>
#include <utility>

#include "calib/rig_formats.h"

namespace duo {
namespace {

// Room for rotations written by hand with four decimals; an error of 1e-3 rad is half a row at 500 px of focal length.
constexpr double kMaxRotationError = 1e-3;
constexpr double kMinBaseline_m = 0.01, kMaxBaseline_m = 5;

Result<void> check_camera(const Camera& camera, const char* side, const std::string& name) {
  const auto [w, h] = camera.size;
  if (std::min(w, h) < 2 || std::max(w, h) > 16384)
    return rig_error(name, "the {} picture is said to be {}x{}; sizes must be 2 to 16384 px", side, w, h);
  for (const double value : {camera.fx_px, camera.fy_px, camera.cx_px, camera.cy_px})
    if (!std::isfinite(value)) return rig_error(name, "the {} camera matrix holds {}; calibrate again", side, value);
  for (const double value : camera.distortion)
    if (!std::isfinite(value)) return rig_error(name, "the {} distortion holds {}; calibrate again", side, value);
  for (const double focal : {camera.fx_px, camera.fy_px})
    if (!(focal >= 0.2 * w && focal <= 10.0 * w))
      return rig_error(name,
                       "the {} focal length {} px does not fit a picture {} px wide (0.2 to 10 times that); calibrate again",
                       side, focal, w);
  if (std::abs(camera.cx_px - 0.5 * w) > w || std::abs(camera.cy_px - 0.5 * h) > h)
    return rig_error(name, "the {} principal point ({}, {}) px is far outside the {}x{} picture; calibrate again", side,
                     camera.cx_px, camera.cy_px, w, h);
  return {};
}

Result<void> check_rotation(const Mat3& r, const std::string& name) {
  for (const double value : r.m)
    if (!std::isfinite(value)) return rig_error(name, "the rotation holds {}; calibrate again", value);
  const Mat3 product = r * transposed(r);
  double error = 0;
  for (std::size_t i = 0; i < 9; ++i) error = std::max(error, std::abs(product.m[i] - Mat3{}.m[i]));
  if (!(error <= kMaxRotationError))
    return rig_error(name, "the rotation is not orthonormal (off by {:.3g}); write it with more digits or calibrate again",
                     error);
  if (determinant(r) < 0) return rig_error(name, "the rotation mirrors (determinant -1); calibrate again");
  return {};
}

Result<void> check_baseline(Vec3 t_m, const std::string& name) {
  for (const double value : {t_m.x, t_m.y, t_m.z})
    if (!std::isfinite(value)) return rig_error(name, "the translation holds {}; calibrate again", value);
  const double baseline_m = norm(t_m);
  if (!(baseline_m <= kMaxBaseline_m))
    return rig_error(name,
                     "the cameras would be {:.4g} m apart; the translation must be in metres (divide millimetres by 1000, "
                     "centimetres by 100)",
                     baseline_m);
  if (baseline_m < kMinBaseline_m)
    return rig_error(name, "the cameras would be {:.4g} m apart; at least {} m is needed, in metres", baseline_m,
                     kMinBaseline_m);
  if (std::abs(t_m.x) < std::max(std::abs(t_m.y), std::abs(t_m.z)))
    return rig_error(name, "the cameras are not side by side (translation {:.4g} {:.4g} {:.4g} m); mount them in a row", t_m.x,
                     t_m.y, t_m.z);
  if (t_m.x > 0)
    return rig_error(name, "left and right are swapped (translation x is {:.4g} m, must be negative); swap the cameras", t_m.x);
  return {};
}

/// What a calibration wrote down about itself.
Result<void> check_record(const Rig& rig, const std::string& name) {
  const RigErrors& e = rig.errors;
  const std::pair<const char*, double> errors[] = {{"reprojection_rms_px", rig.reprojection_rms_px},
                                                   {"left_px", e.left_px},
                                                   {"right_px", e.right_px},
                                                   {"row_px", e.row_px},
                                                   {"held_out_px", e.held_out_px},
                                                   {"held_out_row_px", e.held_out_row_px}};
  for (const auto& [what, value] : errors)
    if (!(value >= 0 && std::isfinite(value))) return rig_error(name, "{} is {}; it must be 0 (unknown) or more", what, value);
  if (!std::isfinite(rig.time_offset_s)) return rig_error(name, "the time offset is {}; calibrate again", rig.time_offset_s);
  if (!rig.uncertainty) return {};
  const RigUncertainty& u = *rig.uncertainty;
  for (const double value : {u.left_focal_px, u.right_focal_px, u.tilt_rad, u.pan_rad, u.roll_rad, u.baseline_m, u.depth_m[0],
                             u.depth_m[1], u.depth_m[2]})
    if (!(value >= 0 && std::isfinite(value))) return rig_error(name, "an uncertainty is {}; calibrate again", value);
  return {};
}

}  // namespace

Result<void> check_rig(const Rig& rig, const std::string& name) {
  DUO_TRY(check_camera(rig.left, "left", name));
  DUO_TRY(check_camera(rig.right, "right", name));
  if (!(rig.left.size == rig.right.size))
    return rig_error(name, "the left picture is {}x{} and the right {}x{}; both must have one size", rig.left.size.width,
                     rig.left.size.height, rig.right.size.width, rig.right.size.height);
  DUO_TRY(check_rotation(rig.right_from_left.rotation, name));
  DUO_TRY(check_baseline(rig.right_from_left.t_m, name));
  return check_record(rig, name);
}

}  // namespace duo
