#include "calib/align_match.h"

#include <Eigen/Core>
#include <cmath>
#include <vector>

#include "calib/normal_equations.h"

namespace duo {
namespace {

double sample(View<const float> src, double x, double y) {
  const int x0 = static_cast<int>(x), y0 = static_cast<int>(y);
  const double fx = x - x0, fy = y - y0;
  const float *a = src.row(y0) + x0, *b = src.row(y0 + 1) + x0;
  return (1 - fy) * ((1 - fx) * a[0] + fx * a[1]) + fy * ((1 - fx) * b[0] + fx * b[1]);
}

/// Whether all that lies within these distances can be sampled, and a pixel more for slopes.
bool inside(View<const float> src, Vec2 at, double reach_x, double reach_y) {
  return at.x - reach_x >= 1 && at.y - reach_y >= 1 && at.x + reach_x < src.width() - 2 && at.y + reach_y < src.height() - 2;
}

/// The square around the left point, its mean taken away.
struct Patch {
  int radius;
  std::vector<double> values;
  double square_sum = 0;
};

Patch cut_patch(View<const float> left, Vec2 at, int radius) {
  Patch patch{radius, {}};
  double sum = 0;
  for (int dy = -radius; dy <= radius; ++dy)
    for (int dx = -radius; dx <= radius; ++dx) sum += patch.values.emplace_back(sample(left, at.x + dx, at.y + dy));
  const double mean = sum / static_cast<double>(patch.values.size());
  for (double& value : patch.values) {
    value -= mean;
    patch.square_sum += value * value;
  }
  return patch;
}

/// Where the patch lies in the right picture: (dx, dy) of it at (x + stretch dx + shear dy, y + dy).
struct Place {
  Vec2 at;
  double stretch = 1, shear = 0;
};
constexpr double kMostStretch = 0.4, kMostShear = 0.4;

constexpr int kUnknowns = 6;  // shift x, shift y, stretch, shear, gain, offset
using Unknowns = Eigen::Matrix<double, kUnknowns, 1>;

constexpr double kNoise_gray = 2;  // of a picture that was smoothed

struct Round {
  Unknowns step;
  double correlation;  // at the place before the step
  double sigma_y_px;   // what noise of the pictures leaves unknown of the row; not finite where nothing is known
};

/// right(place + step) = gain * patch + offset, made linear in the step and solved.
Round solve_round(View<const float> right, const Patch& patch, const Place& place) {
  Eigen::Matrix<double, kUnknowns, kUnknowns> information = Eigen::Matrix<double, kUnknowns, kUnknowns>::Zero();
  Unknowns pull = Unknowns::Zero();
  double sum = 0, square = 0, product = 0;
  const double* left = patch.values.data();
  for (int dy = -patch.radius; dy <= patch.radius; ++dy)
    for (int dx = -patch.radius; dx <= patch.radius; ++dx, ++left) {
      const double x = place.at.x + place.stretch * dx + place.shear * dy, y = place.at.y + dy;
      const double value = sample(right, x, y);
      const double slope_x = (sample(right, x + 1, y) - sample(right, x - 1, y)) / 2,
                   slope_y = (sample(right, x, y + 1) - sample(right, x, y - 1)) / 2;
      Unknowns slope;
      slope << slope_x, slope_y, slope_x * dx, slope_x * dy, -*left, -1;
      information += slope * slope.transpose();
      pull -= value * slope;
      sum += value;
      square += value * value;
      product += value * *left;
    }
  const double right_square_sum = square - sum * sum / static_cast<double>(patch.values.size());
  return {solve_normal(information, pull), product / std::sqrt(patch.square_sum * right_square_sum),
          kNoise_gray * std::sqrt(inverse_of(information)(1, 1))};
}

}  // namespace

std::optional<Vec2> align_match(View<const float> left, Vec2 left_px, View<const float> right, Vec2 right_px, int radius_px) {
  constexpr int kRounds = 12;
  constexpr double kLeastCorrelation = 0.9, kConverged_px = 0.003, kMostSigma_px = 0.1;
  const double reach_x = radius_px * (1 + kMostStretch + kMostShear);
  if (!inside(left, left_px, radius_px, radius_px)) return {};
  const Patch patch = cut_patch(left, left_px, radius_px);
  Place place{right_px};
  for (int i = 0; i < kRounds; ++i) {
    if (!inside(right, place.at, reach_x, radius_px)) return {};
    const Round round = solve_round(right, patch, place);
    if (!round.step.allFinite()) return {};
    place.at = {place.at.x + round.step[0], place.at.y + round.step[1]};
    place.stretch += round.step[2];
    place.shear += round.step[3];
    if (!(std::hypot(place.at.x - right_px.x, place.at.y - right_px.y) <= radius_px) ||
        std::abs(place.stretch - 1) > kMostStretch || std::abs(place.shear) > kMostShear)
      return {};
    if (std::hypot(round.step[0], round.step[1]) > kConverged_px) continue;
    if (!(round.correlation > kLeastCorrelation && round.sigma_y_px < kMostSigma_px)) return {};
    return place.at;
  }
  return {};
}

}  // namespace duo
