// What a rig can do: common view, disparities to search, steps of depth.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "calib/rectification.h"
#include "calib/rig_formats.h"
#include "duoptic/calibrate.h"

namespace duo {
namespace {

constexpr double kFar_m = 2;
constexpr double kDisparityStep_px = 0.25;  // what matching tells apart on common surfaces

Result<int> disparities_from(const Rectified& geometry, double near_m) {
  constexpr int kLanes = 16, kMost = 1 << 20;
  if (!(near_m > 0)) return rig_error("", "the nearest depth is {} m; it must be above zero", near_m);
  return (static_cast<int>(std::min<double>(geometry.disparity_px(near_m), kMost)) / kLanes + 1) * kLanes;
}

}  // namespace

Result<int> disparities_from(const Rig& rig, double near_m) {
  DUO_TRY_ASSIGN(const Rectified geometry, rectified_geometry(rig, ""));
  return disparities_from(geometry, near_m);
}

Result<int> disparities_for_people(const Rig& rig) {
  DUO_TRY_ASSIGN(const int from_nearest, disparities_from(rig, kNearestPeople_m));
  return std::min(from_nearest, kMostPeopleDisparities);
}

Result<RigDescription> describe_rig(const Rig& rig, double near_m) {
  DUO_TRY_ASSIGN(const Rectified geometry, rectified_geometry(rig, ""));
  RigDescription out{.rectified = geometry.size, .near_m = near_m};
  DUO_TRY_ASSIGN(out.max_disparity, disparities_from(geometry, near_m));
  const std::array<double, 3> depths_m = {1, 2, 3};
  for (std::size_t i = 0; i < depths_m.size(); ++i)
    out.step_m[i] = kDisparityStep_px * depths_m[i] * depths_m[i] / (geometry.focal_px * geometry.baseline_m);

  const Lens left(rig.left), right(rig.right);
  constexpr int kSteps = 64;
  int seen = 0;
  double min_x = 0, max_x = 0;
  for (int j = 0; j < kSteps; ++j)
    for (int i = 0; i < kSteps; ++i) {
      const Vec2 at = {(i + 0.5) * rig.left.size.width / kSteps, (j + 0.5) * rig.left.size.height / kSteps};
      const auto ray = left.ray_of(at);
      if (!ray) continue;
      const auto in_right = right.pixel_of(rig.right_from_left * (kFar_m * *ray));
      if (!in_right || !right.covers(*in_right)) continue;
      min_x = seen == 0 ? ray->x : std::min(min_x, ray->x);
      max_x = seen == 0 ? ray->x : std::max(max_x, ray->x);
      ++seen;
    }
  out.common_share = static_cast<double>(seen) / (kSteps * kSteps);
  out.common_degrees = (std::atan(max_x) - std::atan(min_x)) * 180 / std::numbers::pi;
  return out;
}

}  // namespace duo
