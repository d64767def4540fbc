#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "calib/rectification.h"
#include "calib/rig_formats.h"
#include "duoptic/rig_health.h"

namespace duo {
namespace {

constexpr double kDeg = 180 / std::numbers::pi;

class Doubts {
 public:
  template <class... Args>
  void add(RigVerdict verdict, fmt::format_string<Args...> format, Args&&... args) {
    list_.push_back({verdict, fmt::format(format, std::forward<Args>(args)...)});
  }
  std::vector<RigDoubt> take() { return std::move(list_); }

 private:
  std::vector<RigDoubt> list_;
};

constexpr double kMostOffCentre = 0.15;  // of a webcam's principal point, in parts of the width or height

bool is_off_centre(const Camera& c) {
  return std::abs(c.cx_px - (c.size.width - 1) / 2.0) > kMostOffCentre * c.size.width ||
         std::abs(c.cy_px - (c.size.height - 1) / 2.0) > kMostOffCentre * c.size.height;
}

/// Camera matrices of pictures of another size, which were scaled since or taken at another setting: rows still agree where
/// the lenses bend little, and every depth is wrong.
bool doubt_size(const Rig& rig, Doubts& doubts) {
  if (!is_off_centre(rig.left) || !is_off_centre(rig.right)) return false;
  const std::vector<Size> likely = likely_sizes({rig.left.cx_px, rig.left.cy_px}, {rig.right.cx_px, rig.right.cy_px});
  if (likely.empty()) return false;
  const auto [w, h] = rig.left.size;
  doubts.add(RigVerdict::kRecalibrate,
             "its camera matrices are of pictures of another size: both principal points lie in the middle of about {}x{}, "
             "not of {}x{}; unless the pictures are cropped, calibrate at {}x{}, or give the pictures and the size that they "
             "were calibrated at",
             likely[0].width, likely[0].height, w, h, w, h);
  return true;
}

/// Pixels of the border that no ray reaches, as a share of all.
double blind_share(const Lens& lens) {
  const auto [w, h] = lens.camera().size;
  int blind = 0, all = 0;
  const auto look = [&](int x, int y) {
    ++all;
    blind += !lens.ray_of({double(x), double(y)});
  };
  for (int x = 0; x < w; ++x) look(x, 0), look(x, h - 1);
  for (int y = 0; y < h; ++y) look(0, y), look(w - 1, y);
  return static_cast<double>(blind) / all;
}

/// `size_fits`: the camera matrix is of pictures of this size.
void doubt_camera(const Camera& c, const char* side, bool size_fits, Doubts& doubts) {
  const auto [w, h] = c.size;
  const double across_deg = 2 * std::atan(w / (2 * c.fx_px)) * kDeg;
  if (across_deg < 25 || across_deg > 120)
    doubts.add(RigVerdict::kCanBeImproved,
               "the {} focal length {:.1f} px gives a field of view of {:.0f} degrees; webcams have 50 to 90", side, c.fx_px,
               across_deg);
  if (const double ratio = c.fx_px / c.fy_px; ratio > 1.05 || ratio < 0.95)
    doubts.add(RigVerdict::kCanBeImproved, "the {} pixels would not be square (fx {:.1f}, fy {:.1f} px)", side, c.fx_px,
               c.fy_px);
  if (size_fits && is_off_centre(c))
    doubts.add(RigVerdict::kCanBeImproved, "the {} principal point is {:.0f}, {:.0f} px off the middle of the picture", side,
               c.cx_px - (w - 1) / 2.0, c.cy_px - (h - 1) / 2.0);
  if (const double blind = blind_share(Lens(c)); blind > 0)
    doubts.add(
        RigVerdict::kRecalibrate,
        "the {} distortion turns back inside the picture: {:.0f} % of its border would see nothing; calibrate with views "
        "that reach the corners",
        side, std::max(1.0, 100 * blind));
}

void doubt_pose(const Rig& rig, Doubts& doubts) {
  const Rigid3& pose = rig.right_from_left;
  const double apart_deg = std::acos(std::clamp(pose.rotation(2, 2), -1.0, 1.0)) * kDeg;
  if (pose.rotation(2, 2) <= 0 || pose.rotation(1, 1) <= 0) {
    doubts.add(
        RigVerdict::kRecalibrate,
        "the right camera would look backwards or stand on its head (axes {:.0f} degrees apart): the mirrored solution of "
        "the pose; calibrate again with tilted boards",
        apart_deg);
    return;
  }
  if (const auto geometry = rectified_geometry(rig, "rig"); !geometry)
    doubts.add(RigVerdict::kRecalibrate, "no common view: {}", geometry.error().what);
  else if (apart_deg > 20)
    doubts.add(RigVerdict::kCanBeImproved, "the axes are {:.0f} degrees apart; turn the cameras the same way", apart_deg);
  constexpr double kFarApart_m = 1;
  if (rig.metric && rig.baseline_m() > kFarApart_m)
    doubts.add(
        RigVerdict::kCanBeImproved,
        "the cameras would be {:.2f} m apart: is the translation in squares of the board, or in another unit than metres?",
        rig.baseline_m());
  if (const Vec3 along = normalized(pose.t_m); std::abs(along.y) > 0.35 || std::abs(along.z) > 0.35)
    doubts.add(RigVerdict::kCanBeImproved, "one camera stands {:.0f} degrees above or before the other; mount them in a row",
               std::asin(std::max(std::abs(along.y), std::abs(along.z))) * kDeg);
}

}  // namespace

const char* name_of(RigVerdict verdict) {
  switch (verdict) {
    case RigVerdict::kGood:
      return "good";
    case RigVerdict::kCanBeImproved:
      return "can be improved";
    case RigVerdict::kRecalibrate:
      break;
  }
  return "recalibrate";
}

std::vector<RigDoubt> rig_doubts(const Rig& rig) {
  Doubts doubts;
  const bool size_fits = !doubt_size(rig, doubts);
  doubt_camera(rig.left, "left", size_fits, doubts);
  doubt_camera(rig.right, "right", size_fits, doubts);
  if (const double ratio = rig.left.fx_px / rig.right.fx_px; ratio > 1.1 || ratio < 1 / 1.1)
    doubts.add(RigVerdict::kCanBeImproved, "the focal lengths differ ({:.1f} and {:.1f} px); use two cameras of one kind",
               rig.left.fx_px, rig.right.fx_px);
  doubt_pose(rig, doubts);
  if (const double rms = rig.reprojection_rms_px; rms >= 0.5)
    doubts.add(rms >= 1.5 ? RigVerdict::kRecalibrate : RigVerdict::kCanBeImproved,
               "its calibration fitted to {:.2f} px; a good one fits to less than 0.5", rms);
  if (!rig.metric) doubts.add(RigVerdict::kCanBeImproved, "it is not metric: rows agree, distances are a guess");
  return doubts.take();
}

RigVerdict overall(const std::vector<RigDoubt>& doubts, const SceneHealth* scene) {
  RigVerdict worst = scene != nullptr ? scene->verdict : RigVerdict::kGood;
  for (const RigDoubt& doubt : doubts) worst = std::max(worst, doubt.verdict);
  return worst;
}

}  // namespace duo
