#include "calib/scene_pose.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <opencv2/calib3d.hpp>
#include <utility>

#include "calib/normal_equations.h"
#include "calib/rig_formats.h"
#include "duoptic/statistics.h"

namespace duo {
namespace {

constexpr std::size_t kFewest = 40;  // matches; five would do if they were exact

/// Both rays of a match; none where a lens sees no ray at its pixel.
struct RayPair {
  Vec3 left, right;
  bool seen = false;
};

std::vector<RayPair> rays_of(const Rig& rig, const std::vector<SceneMatch>& matches) {
  const Lens left(rig.left), right(rig.right);
  std::vector<RayPair> out(matches.size());
  for (std::size_t i = 0; i < matches.size(); ++i) {
    const auto a = left.ray_of(matches[i].left_px), b = right.ray_of(matches[i].right_px);
    if (a && b) out[i] = {*a, *b, true};
  }
  return out;
}

double mean_focal_px(const Camera& camera) { return (camera.fx_px + camera.fy_px) / 2; }
double square(double x) { return x * x; }

Mat3 essential_of(const Rig& rig) {
  const Vec3 t = normalized(rig.right_from_left.t_m);
  return Mat3{{0, -t.z, t.y, t.z, 0, -t.x, -t.y, t.x, 0}} * rig.right_from_left.rotation;
}

/// What Sampson's distance is made of: right^T E left over the length of its gradient, in which lengths are pixels.
class EpipolarError {
 public:
  explicit EpipolarError(const Rig& rig)
      : essential_(essential_of(rig)),
        back_(transposed(essential_)),
        per_left_px2_(1 / square(mean_focal_px(rig.left))),
        per_right_px2_(1 / square(mean_focal_px(rig.right))) {}

  void set(const RayPair& rays) {
    rays_ = rays;
    in_right_ = essential_ * rays.left;
    in_left_ = back_ * rays.right;
    product_ = dot(rays.right, in_right_);
    gradient_ = std::sqrt(per_right_px2_ * (square(in_right_.x) + square(in_right_.y)) +
                          per_left_px2_ * (square(in_left_.x) + square(in_left_.y)));
  }
  double px() const { return std::sqrt(2) * product_ / gradient_; }
  /// By a change of the essential matrix, and of its transpose.
  double slope_px(const Mat3& change, const Mat3& change_back) const {
    const Vec3 in_right = change * rays_.left, in_left = change_back * rays_.right;
    const double of_gradient = (per_right_px2_ * (in_right_.x * in_right.x + in_right_.y * in_right.y) +
                                per_left_px2_ * (in_left_.x * in_left.x + in_left_.y * in_left.y)) /
                               gradient_;
    return std::sqrt(2) * (dot(rays_.right, in_right) - product_ * of_gradient / gradient_) / gradient_;
  }

 private:
  Mat3 essential_, back_;
  double per_left_px2_, per_right_px2_;
  RayPair rays_;
  Vec3 in_right_, in_left_;  // lines in both pictures on which the other's point lies
  double product_ = 0, gradient_ = 0;
};

std::vector<double> row_errors_px(const Rig& rig, const std::vector<RayPair>& rays) {
  EpipolarError error(rig);
  std::vector<double> out(rays.size(), std::nan(""));
  for (std::size_t i = 0; i < rays.size(); ++i) {
    if (!rays[i].seen) continue;
    error.set(rays[i]);
    out[i] = error.px();
  }
  return out;
}

Mat3 turn(Vec3 axis_rad) {
  const double angle = norm(axis_rad);
  if (angle < 1e-15) return {};
  const Eigen::Matrix3d r =
      Eigen::AngleAxisd(angle, Eigen::Vector3d(axis_rad.x, axis_rad.y, axis_rad.z) / angle).toRotationMatrix();
  return {{r(0, 0), r(0, 1), r(0, 2), r(1, 0), r(1, 1), r(1, 2), r(2, 0), r(2, 1), r(2, 2)}};
}

/// How far each part has moved from the start, as SceneFreedom counts.
using ScenePlace = std::array<double, kSceneParts>;

Rig moved(const Rig& start, const ScenePlace& by) {
  Rig rig = start;
  const Rigid3 left_turn = {turn({0, by[kLeftPan], by[kLeftRoll]}), {}},
               right_turn = {turn({by[kTilt], by[kRightPan], by[kRightRoll]}), {}};
  rig.right_from_left = right_turn * start.right_from_left * inverse(left_turn);
  const auto change = [&](Camera& camera, double log_focal) {
    camera.fx_px *= std::exp(log_focal);
    camera.fy_px *= std::exp(log_focal);
    camera.distortion[0] += by[kBend];
  };
  change(rig.left, by[kFocal] - by[kFocalRatio] / 2);
  change(rig.right, by[kFocal] + by[kFocalRatio] / 2);
  return rig;
}

/// How the right camera is turned to the left one in `b` and is not in `a`; small.
Vec3 turned(const Rig& a, const Rig& b) {
  const Mat3 r = b.right_from_left.rotation * transposed(a.right_from_left.rotation);
  return 0.5 * Vec3{r(2, 1) - r(1, 2), r(0, 2) - r(2, 0), r(1, 0) - r(0, 1)};
}

/// Residuals of the matches at a place, with their slopes by every part that is free.
class Problem {
 public:
  Problem(const Rig& start, const SceneFreedom& freedom, const std::vector<SceneMatch>& matches, int repeats)
      : start_(start), matches_(matches), repeats_(repeats), rays_(rays_of(start, matches)), lens_held_(freedom[kFocal] == 0) {
    for (std::size_t part = 0; part < kSceneParts; ++part)
      if (freedom[part] > 0) free_.push_back(part);
  }
  const std::vector<std::size_t>& free() const { return free_; }
  int repeats() const { return repeats_; }

  /// By their weights.
  std::vector<double> errors(const ScenePlace& at) const {
    const Rig rig = moved(start_, at);
    std::vector<double> out = lens_held_ ? row_errors_px(rig, rays_) : row_errors_px(rig, rays_of(rig, matches_));
    for (std::size_t i = 0; i < out.size(); ++i) out[i] *= matches_[i].weight;
    return out;
  }

  Eigen::MatrixXd slopes(const ScenePlace& at) const {
    Eigen::MatrixXd out = lens_held_ ? slopes_by_pose(at) : slopes_by_steps(at);
    for (std::size_t i = 0; i < matches_.size(); ++i) out.row(static_cast<Eigen::Index>(i)) *= matches_[i].weight;
    return out;
  }

 private:
  static constexpr double kStep = 1e-6;
  struct Steps {
    Rig before, after;
  };
  Steps steps(const ScenePlace& at, std::size_t part) const {
    ScenePlace before = at, after = at;
    before[part] -= kStep;
    after[part] += kStep;
    return {moved(start_, before), moved(start_, after)};
  }

  /// Where the rays stay: from what each part does to the essential matrix.
  Eigen::MatrixXd slopes_by_pose(const ScenePlace& at) const {
    Eigen::MatrixXd out(static_cast<Eigen::Index>(rays_.size()), static_cast<Eigen::Index>(free_.size()));
    EpipolarError error(moved(start_, at));
    std::vector<std::pair<Mat3, Mat3>> changes;  // per part; transposed, too
    for (const std::size_t part : free_) {
      const auto [before, after] = steps(at, part);
      const Mat3 a = essential_of(before), b = essential_of(after);
      Mat3 change;
      for (std::size_t i = 0; i < change.m.size(); ++i) change.m[i] = (b.m[i] - a.m[i]) / (2 * kStep);
      changes.emplace_back(change, transposed(change));
    }
    for (std::size_t i = 0; i < rays_.size(); ++i) {
      error.set(rays_[i]);
      for (std::size_t j = 0; j < free_.size(); ++j)
        out(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)) =
            rays_[i].seen ? error.slope_px(changes[j].first, changes[j].second) : std::nan("");
    }
    return out;
  }

  Eigen::MatrixXd slopes_by_steps(const ScenePlace& at) const {
    Eigen::MatrixXd out(static_cast<Eigen::Index>(matches_.size()), static_cast<Eigen::Index>(free_.size()));
    for (std::size_t j = 0; j < free_.size(); ++j) {
      const auto [before, after] = steps(at, free_[j]);
      const auto a = row_errors_px(before, rays_of(before, matches_)), b = row_errors_px(after, rays_of(after, matches_));
      for (std::size_t i = 0; i < a.size(); ++i)
        out(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)) = (b[i] - a[i]) / (2 * kStep);
    }
    return out;
  }

  const Rig& start_;
  const std::vector<SceneMatch>& matches_;
  int repeats_;
  std::vector<RayPair> rays_;
  bool lens_held_;
  std::vector<std::size_t> free_;
};

/// Spread of most errors, whatever the others are.
double robust_sigma_px(const std::vector<double>& errors) {
  constexpr double kLeast_px = 0.02;
  std::vector<double> sizes;
  for (const double e : errors)
    if (std::isfinite(e)) sizes.push_back(std::abs(e));
  if (sizes.empty()) return kLeast_px;
  return std::max(kLeast_px, 1.4826 * median(sizes));
}

double tukey_weight(double error_px, double sigma_px) {
  const double u = error_px / (4.685 * sigma_px);
  return std::abs(u) < 1 ? (1 - u * u) * (1 - u * u) : 0;  // 0 for NaN
}

double huber_weight(double error_px, double sigma_px) {
  const double u = std::abs(error_px) / (1.345 * sigma_px);
  return u <= 1 ? 1 : u > 1 ? 1 / u : 0;  // 0 for NaN
}

using Weight = double (*)(double error_px, double sigma_px);

/// The normal equations of one round.
struct PoseEquations {
  Eigen::MatrixXd information;
  Eigen::VectorXd pull;
  double sigma_px = 0;  // of the matches' errors
};

PoseEquations equations_at(const Problem& problem, const SceneFreedom& freedom, Weight weight_of, const ScenePlace& at) {
  const auto parts = static_cast<Eigen::Index>(problem.free().size());
  const std::vector<double> errors = problem.errors(at);
  const Eigen::MatrixXd slopes = problem.slopes(at);
  PoseEquations out{Eigen::MatrixXd::Zero(parts, parts), Eigen::VectorXd::Zero(parts), robust_sigma_px(errors)};
  for (std::size_t i = 0; i < errors.size(); ++i) {
    const auto slope = slopes.row(static_cast<Eigen::Index>(i));
    const double weight = weight_of(errors[i], out.sigma_px) / (out.sigma_px * out.sigma_px * problem.repeats());
    if (weight == 0 || !slope.allFinite()) continue;
    for (Eigen::Index j = 0; j < parts; ++j) {
      out.pull[j] -= weight * errors[i] * slope[j];
      for (Eigen::Index k = 0; k < parts; ++k) out.information(j, k) += weight * slope[j] * slope[k];
    }
  }
  for (Eigen::Index j = 0; j < parts; ++j) {
    const std::size_t part = problem.free()[static_cast<std::size_t>(j)];
    const double held = 1 / (freedom[part] * freedom[part]);
    out.information(j, j) += held;
    out.pull[j] -= held * at[part];
  }
  return out;
}

struct Solution {
  ScenePlace at;
  Eigen::MatrixXd covariance;
  double sigma_px = 0;
};

/// Gauss-Newton from a place near the solution.
Result<Solution> solve(const Problem& problem, const SceneFreedom& freedom, Weight weight_of, ScenePlace at) {
  constexpr int kRounds = 100;
  constexpr double kLongestStep = 0.3, kConverged = 1e-7;  // radians, as in 0.0001 px
  const auto parts = static_cast<Eigen::Index>(problem.free().size());
  PoseEquations equations;
  for (int round = 0; round < kRounds; ++round) {
    equations = equations_at(problem, freedom, weight_of, at);
    Eigen::VectorXd step = solve_normal(equations.information, equations.pull);
    if (!step.allFinite()) return Error{ErrorCode::kBadInput, "no pose fits the points of the scene; show one with more depth"};
    double longest = 0;  // in standard deviations; the problem is far from linear in the focal length
    for (Eigen::Index j = 0; j < parts; ++j)
      longest = std::max(longest, std::abs(step[j]) / freedom[problem.free()[static_cast<std::size_t>(j)]]);
    if (longest > kLongestStep) step *= kLongestStep / longest;
    for (Eigen::Index j = 0; j < parts; ++j) at[problem.free()[static_cast<std::size_t>(j)]] += step[j];
    if (step.cwiseAbs().maxCoeff() < kConverged) break;
  }
  return Solution{at, inverse_of(equations.information), equations.sigma_px};
}

/// What even a good calibration leaves of the lenses: rows that are off alike in whole parts of the picture. More matches take
/// the noise away, and not this.
double systematic_px(Size size) { return std::max(0.03, size.width / 20000.0); }

/// One standard deviation of the turn of the right camera to the left, from that of all parts.
Vec3 turn_sigma(const Rig& start, const Problem& problem, const ScenePlace& at, const Eigen::MatrixXd& covariance) {
  constexpr double kStep = 1e-5;
  Eigen::MatrixXd slopes(3, covariance.cols());
  for (Eigen::Index j = 0; j < covariance.cols(); ++j) {
    ScenePlace before = at, after = at;
    before[problem.free()[static_cast<std::size_t>(j)]] -= kStep;
    after[problem.free()[static_cast<std::size_t>(j)]] += kStep;
    const Vec3 change = (1 / (2 * kStep)) * turned(moved(start, before), moved(start, after));
    slopes.col(j) << change.x, change.y, change.z;
  }
  const Eigen::Vector3d variance = (slopes * covariance * slopes.transpose()).diagonal().cwiseMax(0);
  return {std::sqrt(variance[0]), std::sqrt(variance[1]), std::sqrt(variance[2])};
}

}  // namespace

std::vector<double> row_errors_px(const Rig& rig, const std::vector<SceneMatch>& matches) {
  return row_errors_px(rig, rays_of(rig, matches));
}

Result<std::vector<SceneMatch>> agreeing_matches(const Rig& lenses, const SceneMatches& scene) {
  constexpr double kReach_px = 1.5;
  std::vector<cv::Point2d> left, right;
  std::vector<SceneMatch> seen, agreeing;
  const auto rays = rays_of(lenses, scene.matches);
  for (std::size_t i = 0; i < rays.size(); ++i) {
    if (!rays[i].seen) continue;
    const double f = mean_focal_px(lenses.left);
    left.emplace_back(f * rays[i].left.x, f * rays[i].left.y);
    right.emplace_back(f * rays[i].right.x, f * rays[i].right.y);
    seen.push_back(scene.matches[i]);
  }
  if (seen.size() >= kFewest) {
    std::vector<std::uint8_t> inside;
    cv::findFundamentalMat(left, right, cv::USAC_MAGSAC, kReach_px, 0.9999, 20000, inside);
    for (std::size_t i = 0; i < inside.size(); ++i)
      if (inside[i] != 0) agreeing.push_back(seen[i]);
  }
  if (agreeing.size() < kFewest)
    return Error{
        ErrorCode::kBadInput,
        fmt::format("the two views have only {} points in common that agree ({} matched in {} pair{}), {} are needed; show "
                    "both cameras a scene with texture, in light",
                    agreeing.size(), scene.matches.size(), scene.pairs, scene.pairs == 1 ? "" : "s", kFewest)};
  return agreeing;
}

Result<ScenePose> fit_scene_pose(const Rig& start, const SceneFreedom& freedom, const std::vector<SceneMatch>& matches,
                                 int as_one, bool neighbours_alike) {
  constexpr int kIndependent = 50;
  const bool lens_free = freedom[kFocal] > 0;
  const int repeats = lens_free ? std::max(as_one, static_cast<int>(matches.size()) / kIndependent) : as_one;
  ScenePlace near{};
  if (lens_free) {  // a lens that is free from the start runs away before the pose is near
    SceneFreedom lens_held = freedom;
    lens_held[kFocal] = lens_held[kFocalRatio] = lens_held[kBend] = 0;
    DUO_TRY_ASSIGN(const Solution first, solve(Problem(start, lens_held, matches, repeats), lens_held, huber_weight, near));
    near = first.at;
  }
  const Problem problem(start, freedom, matches, repeats);
  // Tukey's weights alone could settle where the points of one surface agree and all nearer ones count as wrong.
  DUO_TRY_ASSIGN(const Solution fair, solve(problem, freedom, huber_weight, near));
  DUO_TRY_ASSIGN(const Solution solution, solve(problem, freedom, tukey_weight, fair.at));

  ScenePose pose;
  pose.rig = moved(start, solution.at);
  pose.turned_rad = turned(start, pose.rig);
  const std::vector<double> errors = problem.errors(solution.at);
  double sum = 0, weights = 0;
  for (std::size_t i = 0; i < errors.size(); ++i) {
    if (tukey_weight(errors[i], solution.sigma_px) == 0) continue;
    ++pose.used;
    sum += errors[i] * errors[i];
    weights += square(matches[i].weight);
  }
  pose.row_rms_px = pose.used > 0 ? std::sqrt(sum / pose.used) : 0;
  const double alike =
      lens_free ? 1
                : (1 + weights * square(systematic_px(start.left.size) / solution.sigma_px)) / (neighbours_alike ? 1 : repeats);
  pose.turn_sigma_rad = turn_sigma(start, problem, solution.at, alike * solution.covariance);
  return pose;
}

}  // namespace duo
