#include "calib/align_match.h"

#include <Eigen/Core>
#include <algorithm>
#include <array>
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

SlopedPixel sample(const SlopedPixel* upper, const SlopedPixel* lower, float fx, float fy) {
  const auto mix = [&](float SlopedPixel::*part) {
    const float a = upper[0].*part + fx * (upper[1].*part - upper[0].*part),
                b = lower[0].*part + fx * (lower[1].*part - lower[0].*part);
    return a + fy * (b - a);
  };
  return {mix(&SlopedPixel::value), mix(&SlopedPixel::slope_x), mix(&SlopedPixel::slope_y), mix(&SlopedPixel::none)};
}

/// Whether all that lies within these distances can be sampled, and a pixel more for slopes.
template <class T>
bool inside(View<const T> src, Vec2 at, double reach_x, double reach_y) {
  return at.x - reach_x >= 1 && at.y - reach_y >= 1 && at.x + reach_x < src.width() - 2 && at.y + reach_y < src.height() - 2;
}

/// The square around the left point, its mean taken away.
struct Patch {
  int radius;
  std::vector<float> values;
  double square_sum = 0;
};

Patch cut_patch(View<const float> left, Vec2 at, int radius) {
  Patch patch{radius, {}};
  patch.values.reserve(static_cast<std::size_t>(2 * radius + 1) * static_cast<std::size_t>(2 * radius + 1));
  double sum = 0;
  for (int dy = -radius; dy <= radius; ++dy)
    for (int dx = -radius; dx <= radius; ++dx)
      sum += patch.values.emplace_back(static_cast<float>(sample(left, at.x + dx, at.y + dy)));
  const auto mean = static_cast<float>(sum / static_cast<double>(patch.values.size()));
  for (float& value : patch.values) {
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

// What a pixel adds to the normal equations: its slopes by shift x, shift y, stretch, shear, gain, offset; its value; none.
constexpr std::size_t kUnknowns = 6, kOfGain = 4, kOfOffset = 5, kOfValue = 6, kPixelTerms = 8;
using PixelTerms = std::array<float, kPixelTerms>;
using TermProducts = std::array<PixelTerms, kOfValue + 1>;  // of two of them each, summed

struct Round {
  Eigen::MatrixXd information;
  Eigen::VectorXd step;
  double correlation;  // at the place before the step
  /// What noise of the pictures leaves unknown of the row; not finite where nothing is known.
  double sigma_y_px(double noise_gray) const { return noise_gray * std::sqrt(inverse_of(information)(1, 1)); }
};

/// Of a row of the patch. Levels count from `level`, so that single floats carry their squares.
TermProducts row_products(View<const SlopedPixel> right, const float* patch_row, int radius, const Place& place, int dy,
                          float level) {
  const double y = place.at.y + dy;
  const int y0 = static_cast<int>(y);
  const auto fy = static_cast<float>(y - y0);
  const SlopedPixel *upper = right.row(y0), *lower = right.row(y0 + 1);
  TermProducts sums{};
  for (int dx = -radius; dx <= radius; ++dx, ++patch_row) {
    const double x = place.at.x + place.stretch * dx + place.shear * dy;
    const int x0 = static_cast<int>(x);
    const SlopedPixel p = sample(upper + x0, lower + x0, static_cast<float>(x - x0), fy);
    const PixelTerms terms = {
        p.slope_x,       p.slope_y, p.slope_x * static_cast<float>(dx), p.slope_x * static_cast<float>(dy), -*patch_row, -1,
        p.value - level, 0};
    for (std::size_t i = 0; i < sums.size(); ++i)
      for (std::size_t j = 0; j < kPixelTerms; ++j) sums[i][j] += terms[i] * terms[j];
  }
  return sums;
}

/// right(place + step) = gain * patch + offset, made linear in the step and solved.
Round solve_round(View<const SlopedPixel> right, const Patch& patch, const Place& place) {
  const float level = right.row(static_cast<int>(place.at.y))[static_cast<int>(place.at.x)].value;
  std::array<std::array<double, kPixelTerms>, kOfValue + 1> sums{};
  const float* patch_row = patch.values.data();
  for (int dy = -patch.radius; dy <= patch.radius; ++dy, patch_row += 2 * patch.radius + 1) {
    const TermProducts of_row = row_products(right, patch_row, patch.radius, place, dy, level);
    for (std::size_t i = 0; i < sums.size(); ++i)
      for (std::size_t j = 0; j < kPixelTerms; ++j) sums[i][j] += of_row[i][j];
  }
  Round round{Eigen::MatrixXd(kUnknowns, kUnknowns), Eigen::VectorXd(kUnknowns), 0};
  for (std::size_t i = 0; i < kUnknowns; ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    for (std::size_t j = 0; j < kUnknowns; ++j) round.information(row, static_cast<Eigen::Index>(j)) = sums[i][j];
    round.step[row] = -sums[i][kOfValue];
  }
  const double sum = -sums[kOfOffset][kOfValue], square = sums[kOfValue][kOfValue], product = -sums[kOfGain][kOfValue];
  const double right_square_sum = square - sum * sum / static_cast<double>(patch.values.size());
  round.correlation = product / std::sqrt(patch.square_sum * right_square_sum);
  round.step = solve_normal(round.information, round.step);
  return round;
}

}  // namespace

void put_slopes(View<const float> picture, Image<SlopedPixel>& out) {
  const auto [w, h] = picture.size();
  if (out.size() != picture.size()) out = Image<SlopedPixel>(picture.size());
  for (int y = 0; y < h; ++y) {
    const float *row = picture.row(y), *above = picture.row(std::max(0, y - 1)), *below = picture.row(std::min(h - 1, y + 1));
    SlopedPixel* to = out.row(y);
    for (int x = 1; x + 1 < w; ++x) to[x] = {row[x], (row[x + 1] - row[x - 1]) / 2, (below[x] - above[x]) / 2, 0};
    for (const int x : {0, w - 1}) to[x] = {row[x], 0, 0, 0};
    if (y == 0 || y == h - 1)
      for (int x = 0; x < w; ++x) to[x].slope_y = 0;
  }
}

std::optional<Vec2> align_match(View<const float> left, Vec2 left_px, View<const SlopedPixel> right, Vec2 right_px,
                                int radius_px, const AlignLimits& limits) {
  constexpr int kRounds = 12;
  constexpr double kConverged_px = 0.003;
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
    if (!(round.correlation > limits.least_correlation && round.sigma_y_px(limits.noise_gray) < limits.most_sigma_px))
      return {};
    return place.at;
  }
  return {};
}

}  // namespace duo
