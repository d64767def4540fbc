#include "calib/lens_left_over.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "calib/normal_equations.h"
#include "duoptic/statistics.h"

namespace duo {
namespace {

constexpr int kParts = 9;
using Parts = Eigen::Matrix<double, kParts, 1>;
using PartsMatrix = Eigen::Matrix<double, kParts, kParts>;

LensLeftOver lens_of(const Parts& p) { return {p[0], p[1], p[2], p[3], p[4], p[5], p[6], p[7], p[8], 0, 0}; }

Vec2 from_middle(Vec2 px, Size size) {
  const double half = size.width / 2.0;
  return {(px.x - (size.width - 1) / 2.0) / half, (px.y - (size.height - 1) / 2.0) / half};
}

Vec2 to_px(Vec2 at, Size size) {
  const double half = size.width / 2.0;
  return {at.x * half + (size.width - 1) / 2.0, at.y * half + (size.height - 1) / 2.0};
}

double radius(const LensLeftOver& l, Vec2 at) { return std::hypot(at.x - l.middle_x, at.y - l.middle_y); }

Vec2 put_right(const LensLeftOver& l, Vec2 at) {
  const double a = at.x - l.middle_x, b = at.y - l.middle_y, r2 = a * a + b * b, bend = r2 * (l.bend2 + r2 * l.bend4);
  const double x = at.x + a * bend, y = at.y + b * bend;
  return {(1 + l.zoom) * x - l.roll * y + l.pan * x * x + l.tilt * x * y,
          (1 + l.zoom) * y + l.roll * x + l.pan * x * y + l.tilt * y * y + l.down};
}

/// Slopes of both coordinates by every part.
std::pair<Parts, Parts> slopes(const Parts& parts, Vec2 at) {
  constexpr double kStep = 1e-6;
  Parts of_x, of_y;
  for (int i = 0; i < kParts; ++i) {
    Parts before = parts, after = parts;
    before[i] -= kStep;
    after[i] += kStep;
    const Vec2 a = put_right(lens_of(before), at), b = put_right(lens_of(after), at);
    of_x[i] = (b.x - a.x) / (2 * kStep);
    of_y[i] = (b.y - a.y) / (2 * kStep);
  }
  return {of_x, of_y};
}

/// How far out a lens keeps the order of its circles, with room.
double order_kept(const LensLeftOver& l) {
  constexpr double kFlattest = 0.25, kStep = 0.01;
  double r = 0;
  while (r < 1.5 && 1 + 3 * l.bend2 * r * r + 5 * l.bend4 * r * r * r * r > kFlattest) r += kStep;
  return r;
}

}  // namespace

std::vector<double> lens_row_errors_px(const LensLeftOver& lens, const SceneMatches& scene) {
  std::vector<double> out;
  for (const SceneMatch& m : scene.matches)
    out.push_back((put_right(lens, from_middle(m.right_px, scene.size)).y - from_middle(m.left_px, scene.size).y) *
                  scene.size.width / 2);
  return out;
}

std::optional<LensLeftOver> fit_lens_left_over(const SceneMatches& scene) {
  constexpr std::size_t kLeastPoints = 100;
  constexpr double kFarthest = 0.04;  // of the height: rows that differ by more are matched wrongly
  constexpr int kRounds = 8;
  constexpr double kScale_px = 0.5, kFinest_px = 0.1, kClose_px = 1.5;
  constexpr double kShared = 2;  // neighbours are wrong together: errors are so much larger than of points that are not
  const double px = scene.size.width / 2.0;
  SceneMatches near{scene.size, scene.pairs, false, {}};
  for (const SceneMatch& m : scene.matches)
    if (std::abs(m.right_px.y - m.left_px.y) < kFarthest * scene.size.height) near.matches.push_back(m);
  if (near.matches.size() < kLeastPoints) return {};

  Parts prior;  // one standard deviation: px / half width, rad, of 1
  prior << 0.03, 0.02, 0.02, 0.01, 0.01, 0.1, 0.2, 0.04, 0.04;
  Parts parts = Parts::Zero();
  PartsMatrix normal;
  for (double scale = std::max(kScale_px, scene.size.width / 480.0);; scale = std::max(scale / 2, kScale_px)) {
    for (int round = 0; round < kRounds; ++round) {
      normal = prior.cwiseAbs2().cwiseInverse().asDiagonal();
      Parts pull = -parts.cwiseQuotient(prior.cwiseAbs2());
      for (const SceneMatch& m : near.matches) {
        const Vec2 at = from_middle(m.right_px, scene.size);
        const double error = (put_right(lens_of(parts), at).y - from_middle(m.left_px, scene.size).y) * px / scale;
        const Parts slope = slopes(parts, at).second * (px / scale);
        const double weight = 1 / (1 + error * error);
        normal += weight * slope * slope.transpose();
        pull -= weight * error * slope;
      }
      Parts step = solve_normal(normal, pull);
      const double longest = step.cwiseAbs().cwiseQuotient(prior).maxCoeff();
      if (longest > 1) step /= longest;
      parts += step;
    }
    if (scale <= kScale_px) break;
  }
  if (!parts.allFinite()) return {};

  LensLeftOver lens = lens_of(parts);
  const PartsMatrix covariance = inverse_of(normal);
  const std::vector<double> errors = lens_row_errors_px(lens, near);
  struct Column {
    double off_px, sigma_px;
  };
  std::vector<Column> columns;
  std::vector<double> radii, off;
  for (const double e : errors)
    if (std::abs(e) < kClose_px) off.push_back(std::abs(e));
  if (off.size() < kLeastPoints || off.size() < errors.size() / 2) return {};
  const double sigma = kShared * std::max(kFinest_px, 1.4826 * quantile(off, 0.5)) / kScale_px;
  for (std::size_t i = 0; i < errors.size(); ++i) {
    if (std::abs(errors[i]) > kClose_px) continue;
    const Vec2 at = from_middle(near.matches[i].right_px, scene.size);
    const Parts slope = slopes(parts, at).first * px;
    columns.push_back({std::abs(put_right(lens, at).x - at.x) * px, sigma * std::sqrt(slope.dot(covariance * slope))});
    radii.push_back(radius(lens, at));
  }
  std::sort(columns.begin(), columns.end(), [](const Column& a, const Column& b) { return a.off_px < b.off_px; });
  const Column outer = columns[columns.size() * 95 / 100];  // of the tenth that is off most the middle one
  if (outer.off_px < 1 || outer.sigma_px > outer.off_px / 5) return {};
  lens.columns_px = outer.off_px;
  lens.reach = std::min(1.1 * quantile(radii, 0.99), order_kept(lens));
  return lens;
}

LensPlaces::LensPlaces(const RowOffsets& rows) : lens_(rows.lens.value_or(LensLeftOver{})), size_(rows.size) {
  constexpr int kSteps = 360;
  for (int i = 0; i < kSteps; ++i) {
    const double angle = 2 * std::numbers::pi * i / kSteps;
    const Vec2 rim = {lens_.middle_x + lens_.reach * std::cos(angle), lens_.middle_y + lens_.reach * std::sin(angle)};
    farthest_ = std::max(farthest_, radius(lens_, put_right(lens_, rim)));
  }
}

Vec2 LensPlaces::at(int x, int y) {
  const Vec2 want = from_middle({double(x), double(y)}, size_);
  std::optional<Vec2> at;
  if (radius(lens_, want) <= farthest_) {
    if (last_) at = solve(want, *last_);
    if (!at) at = solve(want, want);
  }
  last_ = at;
  if (!at) return {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::quiet_NaN()};
  return to_px(*at, size_);
}

/// Newton's method. Where circles lose their order the way may lead out of the picture, and no place is found.
std::optional<Vec2> LensPlaces::solve(Vec2 want, Vec2 at) const {
  constexpr int kRounds = 12;
  constexpr double kStep = 1e-5;
  const double done = 0.002 / size_.width;
  for (int round = 0; round < kRounds && radius(lens_, at) < 2; ++round) {
    const Vec2 here = put_right(lens_, at), off = {want.x - here.x, want.y - here.y};
    if (std::abs(off.x) < done && std::abs(off.y) < done)
      return radius(lens_, at) <= lens_.reach ? std::optional(at) : std::nullopt;
    const Vec2 right = put_right(lens_, {at.x + kStep, at.y}), below = put_right(lens_, {at.x, at.y + kStep});
    const double xx = (right.x - here.x) / kStep, yx = (right.y - here.y) / kStep, xy = (below.x - here.x) / kStep,
                 yy = (below.y - here.y) / kStep, area = xx * yy - xy * yx;
    at.x += (off.x * yy - off.y * xy) / area;
    at.y += (off.y * xx - off.x * yx) / area;
  }
  return {};
}

}  // namespace duo
