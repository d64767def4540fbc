#include "calib/bundle.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "calib/normal_equations.h"
#include "duoptic/statistics.h"

namespace duo {
namespace {

using Eigen::Matrix3d, Eigen::Vector2d, Eigen::Vector3d;
using Pose6 = Eigen::Matrix<double, 6, 1>;
constexpr double kHuber = 2.5;  // standard deviations up to which a corner has its full weight

Matrix3d matrix(const Mat3& m) { return Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(m.m.data()); }
Vector3d vector(Vec3 v) { return {v.x, v.y, v.z}; }
Matrix3d cross_matrix(const Vector3d& v) {
  return (Matrix3d() << 0, -v.z(), v.y(), v.z(), 0, -v.x(), -v.y(), v.x(), 0).finished();
}

/// exp(turn) and move after the pose.
Rigid3 moved_pose(const Rigid3& pose, const Pose6& step) {
  const Vector3d turn = step.head<3>();
  const double angle = turn.norm();
  const Matrix3d r = (angle > 0 ? Eigen::AngleAxisd(angle, turn / angle).toRotationMatrix() : Matrix3d(Matrix3d::Identity())) *
                     matrix(pose.rotation);
  Rigid3 out;
  Eigen::Map<Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(out.rotation.m.data()) = r;
  out.t_m = {pose.t_m.x + step[3], pose.t_m.y + step[4], pose.t_m.z + step[5]};
  return out;
}

struct Projected {
  Vector2d at;
  Eigen::Matrix<double, 2, 3> by_point;
  Eigen::Matrix<double, 2, kCameraParameters> by_camera;
};

Projected project(const Camera& camera, const Vector3d& p) {
  const auto& k = camera.distortion;
  const double x = p.x() / p.z(), y = p.y() / p.z(), r2 = x * x + y * y;
  const double g = 1 + r2 * (k[0] + r2 * (k[1] + r2 * k[4])), slope = k[0] + r2 * (2 * k[1] + r2 * 3 * k[4]);
  const double u = x * g + 2 * k[2] * x * y + k[3] * (r2 + 2 * x * x), v = y * g + k[2] * (r2 + 2 * y * y) + 2 * k[3] * x * y;
  Eigen::Matrix2d by_ray;
  by_ray(0, 0) = g + 2 * x * x * slope + 2 * k[2] * y + 6 * k[3] * x;
  by_ray(0, 1) = by_ray(1, 0) = 2 * x * y * slope + 2 * k[2] * x + 2 * k[3] * y;
  by_ray(1, 1) = g + 2 * y * y * slope + 6 * k[2] * y + 2 * k[3] * x;
  const Vector2d focal(camera.fx_px, camera.fy_px);
  Projected out;
  out.at = {camera.fx_px * u + camera.cx_px, camera.fy_px * v + camera.cy_px};
  const Eigen::Matrix<double, 2, 3> ray_by_point =
      (Eigen::Matrix<double, 2, 3>() << 1 / p.z(), 0, -x / p.z(), 0, 1 / p.z(), -y / p.z()).finished();
  out.by_point = focal.asDiagonal() * by_ray * ray_by_point;
  out.by_camera << u, 0, 1, 0, x * r2, x * r2 * r2, 2 * x * y, r2 + 2 * x * x, x * r2 * r2 * r2,  //
      0, v, 0, 1, y * r2, y * r2 * r2, r2 + 2 * y * y, 2 * x * y, y * r2 * r2 * r2;
  out.by_camera.rightCols<5>() = focal.asDiagonal() * out.by_camera.rightCols<5>();
  return out;
}

/// Normal equations of one view.
struct Equations {
  SharedMatrix shared = SharedMatrix::Zero();
  Eigen::Matrix<double, kShared, 6> mixed = Eigen::Matrix<double, kShared, 6>::Zero();
  Eigen::Matrix<double, 6, 6> pose = Eigen::Matrix<double, 6, 6>::Zero();
  Shared shared_slope = Shared::Zero();
  Pose6 pose_slope = Pose6::Zero();
  double cost = 0;
};

void add_corner(const Bundle& bundle, int side, const BoardPose& pose, const BoardCorner& corner, Vec3 on_board,
                Equations& out) {
  const Vector3d in_left = vector(pose.left_from_board * on_board);
  const Vector3d turned = in_left - vector(pose.left_from_board.t_m);
  Eigen::Matrix<double, 3, 6> by_pose;
  by_pose << -cross_matrix(turned), Matrix3d::Identity();
  Eigen::Matrix<double, 2, kShared> by_shared = Eigen::Matrix<double, 2, kShared>::Zero();
  Projected seen;
  if (side == 0) {
    seen = project(bundle.left, in_left);
    by_shared.leftCols<9>() = seen.by_camera;
  } else {
    const Matrix3d r = matrix(bundle.right_from_left.rotation);
    const Vector3d rotated = r * in_left;
    seen = project(bundle.right, rotated + vector(bundle.right_from_left.t_m));
    by_shared.middleCols<9>(9) = seen.by_camera;
    by_shared.middleCols<3>(18) = seen.by_point * -cross_matrix(rotated);
    by_shared.rightCols<3>() = seen.by_point;
    by_pose = r * by_pose;
  }
  const Eigen::Matrix<double, 2, 6> by_pose_px = seen.by_point * by_pose;
  const Vector2d error = Vector2d(corner.x_px, corner.y_px) - seen.at;
  const double sigma = bundle.sigma_px[static_cast<std::size_t>(side)], size = error.norm() / (sigma * std::sqrt(2.0));
  const double huber = size > kHuber ? kHuber / size : 1, weight = huber / (sigma * sigma);
  out.cost += (size > kHuber ? 2 * kHuber * size - kHuber * kHuber : size * size) * 2;
  out.shared += weight * by_shared.transpose() * by_shared;
  out.mixed += weight * by_shared.transpose() * by_pose_px;
  out.pose += weight * by_pose_px.transpose() * by_pose_px;
  out.shared_slope += weight * by_shared.transpose() * error;
  out.pose_slope += weight * by_pose_px.transpose() * error;
}

Equations equations(const Bundle& bundle, const BoardView& view, const BoardPose& pose, const Board& board) {
  Equations out;
  for (const BoardCorner& corner : view.left) add_corner(bundle, 0, pose, corner, board.corner_m(corner.id), out);
  for (const BoardCorner& corner : view.right) add_corner(bundle, 1, pose, corner, board.corner_m(corner.id), out);
  for (const int side : {0, 1})  // what is held does not move
    if (const int k3 = 9 * side + 8; !bundle.with_k3[static_cast<std::size_t>(side)]) {
      out.shared.row(k3).setZero(), out.shared.col(k3).setZero();
      out.mixed.row(k3).setZero();
      out.shared_slope[k3] = 0;
    }
  return out;
}

std::vector<Equations> all_equations(const Bundle& bundle, const std::vector<const BoardView*>& views, const Board& board) {
  std::vector<Equations> out;
  for (std::size_t i = 0; i < views.size(); ++i) out.push_back(equations(bundle, *views[i], bundle.poses[i], board));
  return out;
}

/// A view's share in the equations of the shared parameters, its pose eliminated.
struct Reduced {
  SharedMatrix matrix;
  Shared slope;
};

Reduced reduced(const Equations& e, double damping) {
  Eigen::Matrix<double, 6, 6> pose = e.pose;
  pose.diagonal() *= 1 + damping;
  const Eigen::Matrix<double, 6, kShared> solved = solve_normal(pose, e.mixed.transpose());
  return {e.shared - e.mixed * solved, e.shared_slope - solved.transpose() * e.pose_slope};
}

/// Solves with each parameter in its own scale; held ones stay.
Eigen::MatrixXd solve_scaled(SharedMatrix m, const Eigen::MatrixXd& right, bool& good) {
  Shared scale;
  for (int i = 0; i < kShared; ++i) {
    if (m(i, i) <= 0) m(i, i) = 1;
    scale[i] = 1 / std::sqrt(m(i, i));
  }
  const SharedMatrix scaled = scale.asDiagonal() * m * scale.asDiagonal();
  double weakest = 0;
  const Eigen::MatrixXd solved = solve_normal(scaled, scale.asDiagonal() * right, &weakest);
  good = weakest > 1e-12;
  return scale.asDiagonal() * solved;
}

double total_cost(const std::vector<Equations>& all) {
  double cost = 0;
  for (const Equations& e : all) cost += e.cost;
  return cost;
}

/// Median of the residuals' lengths, scaled as if they were Gaussian in x and y.
void measure_noise(const std::vector<const BoardView*>& views, const Board& board, Bundle& bundle) {
  for (const int side : {0, 1}) {
    std::vector<double> lengths;
    for (std::size_t i = 0; i < views.size(); ++i) {
      double sum = 0;
      const auto& corners = side == 0 ? views[i]->left : views[i]->right;
      for (const BoardCorner& c : corners) {
        const double length = (Vector2d(c.x_px, c.y_px) - predict(bundle, side, bundle.poses[i], board.corner_m(c.id))).norm();
        lengths.push_back(length);
        sum += length * length;
      }
      bundle.poses[i].rms_px[static_cast<std::size_t>(side)] =
          corners.empty() ? 0 : std::sqrt(sum / static_cast<double>(corners.size()));
    }
    if (lengths.empty()) continue;
    constexpr double kRayleighMedian = 1.1774;
    bundle.sigma_px[static_cast<std::size_t>(side)] = std::max(1e-3, median(lengths) / kRayleighMedian);
  }
}

bool descend(const std::vector<const BoardView*>& views, const Board& board, Bundle& bundle, bool shared_too) {
  double damping = 1e-4;
  std::vector<Equations> all = all_equations(bundle, views, board);
  for (int round = 0; round < 40; ++round) {
    Shared step = Shared::Zero();
    if (shared_too) {
      SharedMatrix m = SharedMatrix::Zero();
      Shared slope = Shared::Zero();
      for (const Equations& e : all) {
        const Reduced part = reduced(e, damping);
        m += part.matrix, slope += part.slope;
      }
      m.diagonal() *= 1 + damping;
      bool good = true;
      step = solve_scaled(m, slope, good);
      if (!step.allFinite()) return false;
    }
    Bundle next = moved(bundle, step);
    for (std::size_t i = 0; i < views.size(); ++i) {
      Eigen::Matrix<double, 6, 6> pose = all[i].pose;
      pose.diagonal() *= 1 + damping;
      const Pose6 by = solve_normal(pose, all[i].pose_slope - all[i].mixed.transpose() * step);
      next.poses[i].left_from_board = moved_pose(bundle.poses[i].left_from_board, by);
    }
    std::vector<Equations> then = all_equations(next, views, board);
    const double before = total_cost(all), after = total_cost(then);
    if (std::isfinite(after) && after <= before) {
      bundle = std::move(next), all = std::move(then);
      damping = std::max(1e-12, damping / 10);
      if (before - after < 1e-9 * (1 + before)) break;
    } else if ((damping *= 10) > 1e8) {
      break;
    }
  }
  return true;
}

bool find_covariances(const std::vector<const BoardView*>& views, const Board& board, Bundle& bundle) {
  std::vector<Reduced> parts;
  SharedMatrix sum = SharedMatrix::Zero();
  for (const Equations& e : all_equations(bundle, views, board)) {
    parts.push_back(reduced(e, 0));
    sum += parts.back().matrix;
  }
  bool good = true;
  bundle.covariance = solve_scaled(sum, SharedMatrix::Identity(), good);
  if (!good || !bundle.covariance.allFinite()) return false;
  for (const int side : {0, 1})
    if (!bundle.with_k3[static_cast<std::size_t>(side)]) {
      bundle.covariance.row(9 * side + 8).setZero();
      bundle.covariance.col(9 * side + 8).setZero();
    }
  bundle.jackknife.setZero();
  const double n = static_cast<double>(parts.size());
  for (const Reduced& part : parts) {
    bool enough = true;
    const Shared without = solve_scaled(sum - part.matrix, part.slope, enough);
    if (enough && without.allFinite()) bundle.jackknife += (n - 1) / n * without * without.transpose();
  }
  return true;
}

}  // namespace

Bundle moved(const Bundle& bundle, const Shared& step) {
  Bundle out = bundle;
  for (const int side : {0, 1}) {
    Camera& camera = side == 0 ? out.left : out.right;
    const auto by = step.segment<kCameraParameters>(9 * side);
    camera.fx_px += by[0], camera.fy_px += by[1], camera.cx_px += by[2], camera.cy_px += by[3];
    for (int k = 0; k < 5; ++k) camera.distortion[static_cast<std::size_t>(k)] += by[4 + k];
  }
  out.right_from_left = moved_pose(out.right_from_left, step.tail<6>());
  return out;
}

Vector2d predict(const Bundle& bundle, int camera, const BoardPose& pose, Vec3 p_on_board_m) {
  const Vec3 in_left = pose.left_from_board * p_on_board_m;
  return camera == 0 ? project(bundle.left, vector(in_left)).at
                     : project(bundle.right, vector(bundle.right_from_left * in_left)).at;
}

bool adjust(const std::vector<const BoardView*>& views, const Board& board, Bundle& bundle) {
  measure_noise(views, board, bundle);
  for (int round = 0; round < 3; ++round) {  // weights follow the noise, the noise the fit
    if (!descend(views, board, bundle, true)) return false;
    measure_noise(views, board, bundle);
  }
  return descend(views, board, bundle, true) && find_covariances(views, board, bundle);
}

void adjust_poses(const std::vector<const BoardView*>& views, const Board& board, Bundle& bundle) {
  descend(views, board, bundle, false);
  const auto noise = bundle.sigma_px;
  measure_noise(views, board, bundle);
  bundle.sigma_px = noise;
}

}  // namespace duo
