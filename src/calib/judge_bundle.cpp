#include "calib/judge_bundle.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>

#include "calib/rectification.h"

namespace duo {
namespace {

/// The point that two raw pixels show, in the left camera: middle of the shortest way between both rays.
std::optional<Vec3> triangulate(const Lens& left, const Lens& right, const Rigid3& right_from_left, Vec2 at_left,
                                Vec2 at_right) {
  const auto a = left.ray_of(at_left), b = right.ray_of(at_right);
  if (!a || !b) return {};
  const Rigid3 left_from_right = inverse(right_from_left);
  const Vec3 u = *a, v = left_from_right.rotation * *b, w = left_from_right.t_m;
  const double uu = dot(u, u), uv = dot(u, v), vv = dot(v, v), det = uu * vv - uv * uv;
  if (!(det > 1e-12)) return {};
  const double s = (dot(u, w) * vv - dot(v, w) * uv) / det, t = (dot(u, w) * uv - dot(v, w) * uu) / det;
  return 0.5 * (s * u + (w + t * v));
}

/// Calls use(seen left, seen right, id) for each corner seen in both pictures.
template <class F>
void for_each_match(const BoardView& view, F use) {
  for (const BoardCorner& a : view.left) {
    const auto b = std::lower_bound(view.right.begin(), view.right.end(), a.id,
                                    [](const BoardCorner& corner, int id) { return corner.id < id; });
    if (b != view.right.end() && b->id == a.id) use(Vec2{a.x_px, a.y_px}, Vec2{b->x_px, b->y_px}, a.id);
  }
}

/// A mean of squares in the making.
struct Rms {
  double sum = 0;
  int count = 0;
  void add(double value) { sum += value * value, ++count; }
  double value() const { return count > 0 ? std::sqrt(sum / count) : 0; }
};

Rig plain_rig(const Bundle& bundle) {
  Rig rig;
  rig.left = bundle.left;
  rig.right = bundle.right;
  rig.right_from_left = bundle.right_from_left;
  return rig;
}

void add_rows(const BoardView& view, const Rig& rig, const Rectified& geometry, Rms& rows) {
  const Lens left(rig.left), right(rig.right);
  for_each_match(view, [&](Vec2 a, Vec2 b, int) {
    const auto in_left = rectified_from_raw(geometry, geometry.rig_from_left, left, a);
    const auto in_right = rectified_from_raw(geometry, geometry.rig_from_right, right, b);
    if (in_left && in_right) rows.add(in_left->y - in_right->y);
  });
}

/// Standard deviation of a function of the shared parameters, the larger of what both covariances say.
double sigma_of(const Bundle& bundle, const std::function<double(const Bundle&)>& quantity) {
  Shared slope;
  for (int i = 0; i < kShared; ++i) {
    const double h = 0.1 * std::sqrt(std::max(bundle.covariance(i, i), 1e-20));
    slope[i] = (quantity(moved(bundle, h * Shared::Unit(i))) - quantity(moved(bundle, -h * Shared::Unit(i)))) / (2 * h);
  }
  return std::sqrt(std::max(
      {0.0, double(slope.transpose() * bundle.covariance * slope), double(slope.transpose() * bundle.jackknife * slope)}));
}

/// How far points all over the common view, `z_m` away, would come out from where they are: root mean square.
double depth_sigma_m(const Bundle& bundle, double z_m) {
  constexpr int kSteps = 5;
  const Lens left(bundle.left), right(bundle.right);
  Rms sigma;
  for (int j = 0; j < kSteps; ++j)
    for (int i = 0; i < kSteps; ++i) {
      const Vec2 at = {(i + 0.5) * bundle.left.size.width / kSteps, (j + 0.5) * bundle.left.size.height / kSteps};
      const auto ray = left.ray_of(at);
      if (!ray) continue;
      const auto in_right = right.pixel_of(bundle.right_from_left * (z_m * *ray));
      if (!in_right || !right.covers(*in_right)) continue;
      sigma.add(sigma_of(bundle, [&](const Bundle& b) {
        const auto p = triangulate(Lens(b.left), Lens(b.right), b.right_from_left, at, *in_right);
        return p ? p->z : z_m;
      }));
    }
  return sigma.value();
}

RigUncertainty uncertainty_of(const Bundle& bundle) {
  RigUncertainty out;
  const auto of = [&](auto quantity) { return sigma_of(bundle, quantity); };
  const auto larger = [&](int i) { return std::sqrt(std::max(bundle.covariance(i, i), bundle.jackknife(i, i))); };
  out.left_focal_px = of([](const Bundle& b) { return (b.left.fx_px + b.left.fy_px) / 2; });
  out.right_focal_px = of([](const Bundle& b) { return (b.right.fx_px + b.right.fy_px) / 2; });
  out.tilt_rad = larger(18), out.pan_rad = larger(19), out.roll_rad = larger(20);
  out.baseline_m = of([](const Bundle& b) { return norm(b.right_from_left.t_m); });
  for (std::size_t i = 0; i < kJudgedDepths_m.size(); ++i) out.depth_m[i] = depth_sigma_m(bundle, kJudgedDepths_m[i]);
  return out;
}

/// Distances of measured corners from the board's true shape, laid on them as well as it fits (Kabsch, 1976).
void add_shape(const BoardView& view, const Board& board, const Rig& rig, Rms& shape, double& z_sum, int& z_count) {
  const Lens left(rig.left), right(rig.right);
  std::vector<Eigen::Vector3d> measured, truth;
  for_each_match(view, [&](Vec2 a, Vec2 b, int id) {
    const auto p = triangulate(left, right, rig.right_from_left, a, b);
    if (!p) return;
    const Vec3 q = board.corner_m(id);
    measured.emplace_back(p->x, p->y, p->z), truth.emplace_back(q.x, q.y, q.z);
  });
  if (measured.size() < 4) return;
  Eigen::Matrix3Xd m(3, measured.size()), t(3, truth.size());
  for (std::size_t i = 0; i < measured.size(); ++i) {
    m.col(static_cast<Eigen::Index>(i)) = measured[i], t.col(static_cast<Eigen::Index>(i)) = truth[i];
  }
  const Eigen::Matrix4d laid = Eigen::umeyama(t, m, false);
  for (std::size_t i = 0; i < measured.size(); ++i) {
    shape.add((measured[i] - (laid.topLeftCorner<3, 3>() * truth[i] + laid.topRightCorner<3, 1>())).norm());
    z_sum += measured[i].z(), ++z_count;
  }
}

}  // namespace

Rig rig_of(const std::vector<const BoardView*>& views, const Board& board, const Bundle& bundle) {
  Rig rig = plain_rig(bundle);
  std::array<Rms, 2> each;
  Rms both;
  for (std::size_t i = 0; i < views.size(); ++i)
    for (const int side : {0, 1})
      for (const BoardCorner& c : side == 0 ? views[i]->left : views[i]->right) {
        const double off =
            (Eigen::Vector2d(c.x_px, c.y_px) - predict(bundle, side, bundle.poses[i], board.corner_m(c.id))).norm();
        each[static_cast<std::size_t>(side)].add(off), both.add(off);
      }
  rig.reprojection_rms_px = both.value();
  rig.errors.left_px = each[0].value(), rig.errors.right_px = each[1].value();
  if (const auto geometry = rectified_geometry(rig, "")) {
    Rms rows;
    for (const BoardView* view : views) add_rows(*view, rig, *geometry, rows);
    rig.errors.row_px = rows.value();
  }
  rig.uncertainty = uncertainty_of(bundle);
  return rig;
}

HeldOut judge_held_out(const std::vector<const BoardView*>& views, const Board& board, const Bundle& bundle) {
  constexpr std::size_t kFolds = 4;
  Rms reprojection, rows, shape;
  double z_sum = 0;
  int z_count = 0;
  for (std::size_t fold = 0; fold < kFolds; ++fold) {
    std::vector<const BoardView*> kept, out;
    Bundle of_kept = bundle, of_out = bundle;
    of_kept.poses.clear(), of_out.poses.clear();
    for (std::size_t i = 0; i < views.size(); ++i) {
      (i % kFolds == fold ? out : kept).push_back(views[i]);
      (i % kFolds == fold ? of_out : of_kept).poses.push_back(bundle.poses[i]);
    }
    if (!adjust(kept, board, of_kept)) continue;
    of_out.left = of_kept.left, of_out.right = of_kept.right, of_out.right_from_left = of_kept.right_from_left;
    adjust_poses(out, board, of_out);
    const Rig rig = plain_rig(of_out);
    const auto geometry = rectified_geometry(rig, "");
    for (std::size_t i = 0; i < out.size(); ++i) {
      for (const int side : {0, 1})
        for (std::size_t k = 0; k < (side == 0 ? out[i]->left : out[i]->right).size(); ++k)
          reprojection.add(of_out.poses[i].rms_px[static_cast<std::size_t>(side)]);
      if (geometry) add_rows(*out[i], rig, *geometry, rows);
      add_shape(*out[i], board, rig, shape, z_sum, z_count);
    }
  }
  return {reprojection.value(), rows.value(), shape.value(), z_count > 0 ? z_sum / z_count : 0};
}

}  // namespace duo
