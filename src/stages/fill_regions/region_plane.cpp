#include "stages/fill_regions/region_plane.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

namespace duo {
namespace {

constexpr int kSamples = 64, kCompared = 128, kFewestPoints = 20, kNear_q4 = 24, kTwiceLeastArea = 64, kFrontalPercent = 90;

/// Below 2^44: a disparity is below 2^16, a column below 2^16, and 2^12 in practice.
bool through(const PlanePoint& a, const PlanePoint& b, const PlanePoint& c, RegionPlane& out) {
  const std::int64_t x1 = b.x - a.x, y1 = b.y - a.y, x2 = c.x - a.x, y2 = c.y - a.y, area = x1 * y2 - x2 * y1;
  if (std::abs(area) < kTwiceLeastArea) return false;
  const std::int64_t d1 = b.d_q4 - a.d_q4, d2 = c.d_q4 - a.d_q4;
  out = {a, (d1 * y2 - d2 * y1) * (1 << 16) / area, (d2 * x1 - d1 * x2) * (1 << 16) / area};
  return true;
}

int distance_q4(const RegionPlane& plane, const PlanePoint& p) { return std::abs(plane.d_q4(p.y, p.x) - p.d_q4); }

bool is_near(const RegionPlane& plane, const PlanePoint& p) { return distance_q4(plane, p) <= kNear_q4; }

/// The plane of least squares through the points near `plane`. Sums are whole numbers, below 2^62 for 2^24 points: only the
/// last step rounds.
RegionPlane refined(std::span<const PlanePoint> points, const RegionPlane& plane) {
  std::int64_t n = 0, sx = 0, sy = 0, sd = 0, sxx = 0, sxy = 0, syy = 0, sxd = 0, syd = 0;
  for (const PlanePoint& p : points) {
    if (!is_near(plane, p)) continue;
    const std::int64_t x = p.x - plane.at.x, y = p.y - plane.at.y, d = p.d_q4 - plane.at.d_q4;
    n += 1, sx += x, sy += y, sd += d, sxx += x * x, sxy += x * y, syy += y * y, sxd += x * d, syd += y * d;
  }
  if (n < kFewestPoints) return plane;
  const auto about_mean = [n](std::int64_t sum, std::int64_t a, std::int64_t b) {
    return static_cast<double>(sum) - static_cast<double>(a) * static_cast<double>(b) / static_cast<double>(n);
  };
  const double xx = about_mean(sxx, sx, sx), xy = about_mean(sxy, sx, sy), yy = about_mean(syy, sy, sy);
  const double xd = about_mean(sxd, sx, sd), yd = about_mean(syd, sy, sd), area = xx * yy - xy * xy;
  if (area < 1) return plane;  // all on a line
  const auto mean = [n](std::int64_t sum) { return static_cast<int>(sum >= 0 ? (sum + n / 2) / n : (sum - n / 2) / n); };
  const PlanePoint middle = {static_cast<std::uint16_t>(plane.at.y + mean(sy)),
                             static_cast<std::uint16_t>(plane.at.x + mean(sx)),
                             static_cast<std::uint16_t>(plane.at.d_q4 + mean(sd))};
  return {middle, std::llround((xd * yy - yd * xy) / area * (1 << 16)), std::llround((yd * xx - xd * xy) / area * (1 << 16))};
}

}  // namespace

bool region_plane(std::span<const PlanePoint> points, RegionPlane& out) {
  if (points.size() < kFewestPoints) return false;
  std::uint32_t random = 1;  // the generator of Numerical Recipes, 1992
  const auto sample = [&]() -> const PlanePoint& {
    random = random * 1664525U + 1013904223U;
    return points[static_cast<std::size_t>((std::uint64_t{random} * points.size()) >> 32)];
  };
  const std::size_t step = std::max<std::size_t>(1, points.size() / kCompared);
  const auto score = [&](const RegionPlane& plane) {
    int sum = 0;
    for (std::size_t k = 0; k < points.size(); k += step) sum += std::max(0, kNear_q4 - distance_q4(plane, points[k]));
    return sum;
  };
  int best = -1;
  const auto keep_better = [&](const RegionPlane& plane) {
    const int sum = score(plane);
    if (sum > best) best = sum, out = plane;
  };
  for (int i = 0; i < kSamples; ++i) {
    const PlanePoint &a = sample(), &b = sample(), &c = sample();
    RegionPlane plane;
    if (through(a, b, c, plane)) keep_better(plane);
  }
  if (best < 0) return false;
  keep_better(refined(points, out));
  best = (best * kFrontalPercent - 1) / 100;
  for (std::size_t k = 0; k < points.size(); k += step) keep_better({points[k], 0, 0});
  const auto near = std::count_if(points.begin(), points.end(), [&](const PlanePoint& p) { return is_near(out, p); });
  return 2 * static_cast<std::size_t>(near) >= points.size();
}

}  // namespace duo
