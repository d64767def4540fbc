#include <Eigen/Cholesky>
#include <algorithm>
#include <array>

#include "core/rotation.h"
#include "duoptic/statistics.h"
#include "trackers/arm/torso.h"

namespace duo::arm {
namespace {

using Vector6 = Eigen::Matrix<double, 6, 1>;  // turn around the body's origin, then shift
using Matrix6 = Eigen::Matrix<double, 6, 6>;

struct Normal {
  Matrix6 a = Matrix6::Zero();
  Vector6 b = Vector6::Zero();

  /// One residual whose gradient by the point is `by_point`; `arm` leads from the body's origin to the point.
  void add(Vec3 arm, Vec3 by_point, double residual, double weight) {
    const Vec3 by_turn = cross(arm, by_point);
    Vector6 j;
    j << by_turn.x, by_turn.y, by_turn.z, by_point.x, by_point.y, by_point.z;
    a.noalias() += weight * j * j.transpose();
    b.noalias() += weight * residual * j;
  }
};

/// The prediction shifted along the picture by the median of what the points say.
Rigid3 shifted(const Pinhole& camera, const std::vector<TorsoPoint>& points, Rigid3 pose) {
  std::array<double, Torso::kMostPatches> du, dv;
  const std::size_t n = std::min(points.size(), du.size());
  if (n == 0) return pose;
  for (std::size_t i = 0; i < n; ++i) {
    const Vec2 q = camera.project(pose * points[i].p_in_torso_m);
    du[i] = points[i].at_px.x - q.x;
    dv[i] = points[i].at_px.y - q.y;
  }
  const double metre_per_px = pose.t_m.z / camera.focal_px;
  pose.t_m = pose.t_m + metre_per_px * Vec3{median(std::span(du).first(n)), median(std::span(dv).first(n)), 0};
  return pose;
}

/// Adds every point; returns how many fit.
int add_points(const Pinhole& camera, const std::vector<TorsoPoint>& points, const Rigid3& pose, double scale_px,
               Normal& normal) {
  constexpr double kDisparityWeight = 0.5;  // disparity is twice as uncertain (as a variance) as a patch's place
  constexpr double kInlier = 2.5;           // squared residual in scales
  const double f = camera.focal_px, fb = f * camera.baseline_m;
  int inliers = 0;
  for (const TorsoPoint& point : points) {
    const Vec3 arm = pose.rotation * point.p_in_torso_m, p = arm + pose.t_m;
    const Vec2 q = camera.project(p);
    const double iz = 1 / p.z, eu = point.at_px.x - q.x, ev = point.at_px.y - q.y,
                 ed = point.d_px > 0 ? point.d_px - fb * iz : 0;
    const double e2 = (eu * eu + ev * ev + kDisparityWeight * ed * ed) / (scale_px * scale_px);
    const double weight = 1 / ((1 + e2) * (1 + e2));
    inliers += e2 < kInlier;
    normal.add(arm, {f * iz, 0, -f * p.x * iz * iz}, eu, weight);
    normal.add(arm, {0, f * iz, -f * p.y * iz * iz}, ev, weight);
    if (point.d_px > 0) normal.add(arm, {0, 0, -fb * iz * iz}, ed, kDisparityWeight * weight);
  }
  return inliers;
}

/// Holds the pose near the start: 0.03 rad and 0.03 m weigh as much as one point that is off by a pixel. With points enough the
/// shift is only damped.
void add_prior(const Rigid3& start, const Rigid3& pose, bool points_enough, Normal& normal) {
  constexpr double kWeight = 1 / (0.03 * 0.03);
  const Vec3 turn = axis_of(start.rotation * transposed(pose.rotation)), shift = points_enough ? Vec3{} : start.t_m - pose.t_m;
  normal.a.diagonal().array() += kWeight;
  Vector6 back;
  back << turn.x, turn.y, turn.z, shift.x, shift.y, shift.z;
  normal.b += kWeight * back;
}

}  // namespace

TorsoFit fit_torso(const Pinhole& camera, const std::vector<TorsoPoint>& points, const Rigid3& predicted) {
  constexpr double kScalesPx[] = {12, 8, 5, 3, 2, 2, 2, 2};
  constexpr std::size_t kEnough = 4;
  const Rigid3 start = shifted(camera, points, predicted);
  TorsoFit fit{start, 0};
  Rigid3& pose = fit.rig_from_torso;
  for (const double scale_px : kScalesPx) {
    Normal normal;
    fit.inliers = add_points(camera, points, pose, scale_px, normal);
    add_prior(start, pose, points.size() > kEnough, normal);
    const Vector6 x = normal.a.ldlt().solve(normal.b);
    pose.rotation = rotation_of({x[0], x[1], x[2]}) * pose.rotation;
    pose.t_m = pose.t_m + Vec3{x[3], x[4], x[5]};
  }
  return fit;
}

}  // namespace duo::arm
