#include "stages/fill_regions/region_plane.h"

#include <algorithm>
#include <cstdlib>

namespace duo {
namespace {

constexpr int kSamples = 64, kCompared = 128, kFewestPoints = 20, kNear_q4 = 24, kTwiceLeastArea = 64;

/// Below 2^44: a disparity is below 2^16, a column below 2^16, and 2^12 in practice.
bool through(const PlanePoint& a, const PlanePoint& b, const PlanePoint& c, RegionPlane& out) {
  const std::int64_t x1 = b.x - a.x, y1 = b.y - a.y, x2 = c.x - a.x, y2 = c.y - a.y, area = x1 * y2 - x2 * y1;
  if (std::abs(area) < kTwiceLeastArea) return false;
  const std::int64_t d1 = b.d_q4 - a.d_q4, d2 = c.d_q4 - a.d_q4;
  out = {a, (d1 * y2 - d2 * y1) * (1 << 16) / area, (d2 * x1 - d1 * x2) * (1 << 16) / area};
  return true;
}

int distance_q4(const RegionPlane& plane, const PlanePoint& p) { return std::abs(plane.d_q4(p.y, p.x) - p.d_q4); }

}  // namespace

bool region_plane(std::span<const PlanePoint> points, RegionPlane& out) {
  if (points.size() < kFewestPoints) return false;
  std::uint32_t random = 1;  // the generator of Numerical Recipes, 1992
  const auto sample = [&]() -> const PlanePoint& {
    random = random * 1664525U + 1013904223U;
    return points[static_cast<std::size_t>((std::uint64_t{random} * points.size()) >> 32)];
  };
  const std::size_t step = std::max<std::size_t>(1, points.size() / kCompared);
  int best = -1;
  for (int i = 0; i < kSamples; ++i) {
    const PlanePoint &a = sample(), &b = sample(), &c = sample();
    RegionPlane plane;
    if (!through(a, b, c, plane)) continue;
    int score = 0;
    for (std::size_t k = 0; k < points.size(); k += step) score += std::max(0, kNear_q4 - distance_q4(plane, points[k]));
    if (score > best) best = score, out = plane;
  }
  if (best < 0) return false;
  std::size_t near = 0;
  for (const PlanePoint& p : points) near += distance_q4(out, p) <= kNear_q4;
  return 2 * near >= points.size();
}

}  // namespace duo
