#include "trackers/body/lift.h"

#include <algorithm>
#include <cmath>

#include "duoptic/statistics.h"
#include "trackers/body/joints.h"

namespace duo::body {
namespace {

constexpr int kMostSamples = 441;  // 21 x 21
constexpr double kGap_m = 0.02, kLeastGap_px = 0.3;
constexpr double kLeastShare = 0.06;

struct Sample {
  std::uint16_t q4;
  std::uint16_t weight;
};

}  // namespace

Surfaces surfaces_at(const DepthView& depth, Vec2 at_px, double z, double half_m, DepthRange range) {
  Surfaces out;
  const int half = std::clamp(static_cast<int>(half_m * depth.px_per_m(z)), 2, 60), step = half / 10 + 1;
  const int width = depth.d_q4.width(), height = depth.d_q4.height();
  const double x_far = std::clamp(at_px.x, -1e4, 1e4), y_far = std::clamp(at_px.y, -1e4, 1e4);
  const int cx = static_cast<int>(std::floor(x_far + 0.5)), cy = static_cast<int>(std::floor(y_far + 0.5));
  std::array<Sample, kMostSamples> samples;
  std::size_t count = 0;
  int total = 0;
  for (int dy = -half; dy <= half; dy += step)
    for (int dx = -half; dx <= half; dx += step) {
      const int x = cx + dx, y = cy + dy;
      if (x < 0 || y < 0 || x >= width || y >= height) continue;
      const int from_centre = dx * dx + dy * dy;
      const int weight = 4 * from_centre < half * half ? 4 : from_centre < half * half ? 2 : 1;
      total += weight;
      const std::uint16_t q4 = depth.d_q4.at(y, x);
      if (q4 == Disparity::kNone || q4 == 0 || count == samples.size()) continue;
      const double at = depth.z_m(q4);
      if (at < range.near_m || at > range.far_m) continue;
      samples[count++] = {q4, static_cast<std::uint16_t>(weight)};
    }
  if (count == 0) return out;
  std::sort(samples.begin(), samples.begin() + static_cast<std::ptrdiff_t>(count),
            [](const Sample& a, const Sample& b) { return a.q4 != b.q4 ? a.q4 > b.q4 : a.weight > b.weight; });
  std::size_t begin = 0;
  while (begin < count && out.count < out.all.size()) {
    std::size_t end = begin + 1;
    int weight = samples[begin].weight;
    const double z_here = depth.z_m(samples[begin].q4);
    const double gap_px = std::max(kGap_m / depth.m_per_px(z_here), kLeastGap_px);
    while (end < count && samples[end - 1].q4 - samples[end].q4 <= 16 * gap_px) weight += samples[end++].weight;
    int sum = 0;
    std::size_t middle = begin;
    while (2 * (sum + samples[middle].weight) < weight) sum += samples[middle++].weight;
    const double share = static_cast<double>(weight) / std::max(total, 1);
    if (share >= kLeastShare) out.all[out.count++] = {depth.z_m(samples[middle].q4), share, false};
    begin = end;
  }
  return out;
}

double trunk_depth(const DepthView& depth, const std::array<Vec2, 4>& corners_px, DepthRange range) {
  constexpr int kSide = 13;
  std::array<double, kSide * kSide> found;
  std::size_t count = 0;
  int inside = 0;
  for (int j = 0; j < kSide; ++j)
    for (int i = 0; i < kSide; ++i) {
      const double a = 0.1 + 0.8 * i / (kSide - 1), b = 0.05 + 0.9 * j / (kSide - 1);
      const auto mix = [&](double left_up, double right_up, double left_down, double right_down) {
        return (1 - b) * ((1 - a) * left_up + a * right_up) + b * ((1 - a) * left_down + a * right_down);
      };
      const double x = mix(corners_px[0].x, corners_px[1].x, corners_px[2].x, corners_px[3].x);
      const double y = mix(corners_px[0].y, corners_px[1].y, corners_px[2].y, corners_px[3].y);
      if (!(x >= 0 && y >= 0 && x <= depth.d_q4.width() - 1 && y <= depth.d_q4.height() - 1)) continue;
      ++inside;
      const std::uint16_t q4 = depth.d_q4.at(static_cast<int>(y + 0.5), static_cast<int>(x + 0.5));
      if (q4 == Disparity::kNone || q4 == 0) continue;
      const double z = depth.z_m(q4);
      if (z >= range.near_m && z <= range.far_m) found[count++] = z;
    }
  if (inside == 0 || 8 * count < static_cast<std::size_t>(inside) || count < 4) return 0;
  return median(std::span(found.data(), count));
}

bool stands_out(const DepthView& depth, const std::array<Vec2, 4>& corners_px) {
  constexpr int kRows = 9, kColumns = 5;
  constexpr double kLeast_m = 0.06, kLeast_px = 0.5, kFlat_px = 0.6;
  const Vec2 up = mean(corners_px[0], corners_px[1]), down = mean(corners_px[2], corners_px[3]);
  const Vec2 along = {down.x - up.x, down.y - up.y};
  const double length = std::sqrt(square(along.x) + square(along.y));
  if (!(length > 4)) return true;
  // Half as wide as long, also of a trunk that is seen from the side.
  const Vec2 across = {0.5 * -along.y, 0.5 * along.x};
  const auto disparity_px = [&](Vec2 at) -> double {
    if (!(at.x >= 0 && at.y >= 0 && at.x <= depth.d_q4.width() - 1 && at.y <= depth.d_q4.height() - 1)) return 0;
    const std::uint16_t q4 = depth.d_q4.at(static_cast<int>(at.y + 0.5), static_cast<int>(at.x + 0.5));
    return q4 == Disparity::kNone ? 0 : q4 / 16.0;
  };
  // The plane of both sides: disparity is linear in a plane.
  struct Place {
    double a = 0, b = 0, d = 0;
  };
  std::array<Place, 2 * kRows * kColumns> sides;
  std::array<double, static_cast<std::size_t>(kRows * kColumns)> trunk;
  std::size_t side_count = 0, trunk_count = 0;
  const auto place = [&](double a, double b) {
    return Vec2{up.x + a * across.x + b * along.x, up.y + a * across.y + b * along.y};
  };
  for (int j = 0; j < kRows; ++j)
    for (int i = 0; i < kColumns; ++i) {
      const double b = j / (kRows - 1.0), t = i / (kColumns - 1.0);
      for (const double sign : {-1.0, 1.0}) {
        const double a = sign * (1.5 + t);
        if (const double d = disparity_px(place(a, b)); d > 0) sides[side_count++] = {a, b, d};
      }
    }
  if (side_count < sides.size() / 2) return true;
  std::array<std::array<double, 4>, 3> m = {};
  for (const Place& p : std::span(sides.data(), side_count)) {
    const std::array<double, 4> row = {1, p.a, p.b, p.d};
    for (std::size_t i = 0; i < 3; ++i)
      for (std::size_t k = 0; k < 4; ++k) m[i][k] += row[i] * row[k];
  }
  for (std::size_t i = 0; i < 3; ++i) {  // the three sums are positive definite where both sides are seen
    if (!(m[i][i] > 1e-6)) return true;
    for (std::size_t r = 0; r < 3; ++r) {
      if (r == i) continue;
      const double f = m[r][i] / m[i][i];
      for (std::size_t k = i; k < 4; ++k) m[r][k] -= f * m[i][k];
    }
  }
  const auto plane = [&](double a, double b) { return m[0][3] / m[0][0] + a * m[1][3] / m[1][1] + b * m[2][3] / m[2][2]; };
  std::array<double, 2 * kRows * kColumns> off;
  for (std::size_t i = 0; i < side_count; ++i) off[i] = std::abs(sides[i].d - plane(sides[i].a, sides[i].b));
  if (quantile(std::span(off.data(), side_count), 0.8) > kFlat_px) return true;  // no plane
  for (int j = 0; j < kRows; ++j)
    for (int i = 0; i < kColumns; ++i) {
      const double b = j / (kRows - 1.0), a = 0.6 * (2 * i / (kColumns - 1.0) - 1);
      if (const double d = disparity_px(place(a, b)); d > 0) trunk[trunk_count++] = d - plane(a, b);
    }
  if (trunk_count < trunk.size() / 4) return true;
  const double nearer_px = median(std::span(trunk.data(), trunk_count)), there_px = plane(0, 0.5);
  const double z = depth.geometry->focal_px * depth.geometry->baseline_m / std::max(there_px, 0.1);
  return nearer_px > std::max(kLeast_px, kLeast_m / depth.m_per_px(z));
}

}  // namespace duo::body
