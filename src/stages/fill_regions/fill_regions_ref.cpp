#include <algorithm>
#include <cstdlib>
#include <utility>
#include <vector>

#include "core/check.h"
#include "stages/fill_regions/fill_regions.h"

namespace duo::ref {
namespace {

using In = FillRegions;

bool is_flat(View<const std::uint8_t> gray, int y, int x) {
  const auto at = [&](int yy, int xx) {
    return int{gray.at(std::clamp(yy, 0, gray.height() - 1), std::clamp(xx, 0, gray.width() - 1))};
  };
  int along_x = 0, along_y = 0;
  for (int i = -1; i <= 1; ++i) {
    const int weight = i == 0 ? 2 : 1;
    along_x += weight * (at(y + i, x + 1) - at(y + i, x - 1));
    along_y += weight * (at(y + 1, x + i) - at(y - 1, x + i));
  }
  return std::abs(along_x) <= In::kFlatGradient && std::abs(along_y) <= In::kFlatGradient;
}

using Pixels = std::vector<std::pair<int, int>>;  // y, x

/// The flat pixels joined with one; `region` gets `number` there.
Pixels region_of(View<const std::uint8_t> gray, int y0, int x0, int number, View<int> region) {
  Pixels out = {{y0, x0}};
  region.at(y0, x0) = number;
  for (std::size_t i = 0; i < out.size(); ++i) {
    const auto [y, x] = out[i];
    for (const auto& [dy, dx] : {std::pair{-1, 0}, {1, 0}, {0, -1}, {0, 1}}) {
      const int yy = y + dy, xx = x + dx;
      if (yy < 0 || yy >= gray.height() || xx < 0 || xx >= gray.width() || region.at(yy, xx) != 0) continue;
      if (!is_flat(gray, yy, xx) || std::abs(gray.at(yy, xx) - gray.at(y, x)) > In::kFlatStep) continue;
      region.at(yy, xx) = number;
      out.emplace_back(yy, xx);
    }
  }
  std::sort(out.begin(), out.end());
  return out;
}

/// Whether the pixel has its region to all sides.
bool is_inner(View<const std::uint8_t> gray, View<const int> region, int y, int x) {
  const auto same = [&](int yy, int xx) {
    return yy >= 0 && yy < region.height() && xx >= 0 && xx < region.width() && region.at(yy, xx) == region.at(y, x);
  };
  const auto small_step = [&](int a, int b) { return std::abs(gray.at(y, a) - gray.at(y, b)) <= In::kFlatStep; };
  for (int i = 1; i <= In::kInnerColumns; ++i) {
    if (!same(y, x - i) || !same(y, x + i)) return false;
    if (!small_step(x - i, x - i + 1) || !small_step(x + i - 1, x + i)) return false;
  }
  for (int i = 1; i <= In::kInnerRows; ++i)
    if (!same(y - i, x) || !same(y + i, x)) return false;
  return true;
}

}  // namespace

void fill_regions(const FillRegions& in, View<std::uint16_t> d_q4, View<std::uint8_t> origin) {
  DUO_CHECK(in.gray.size() == d_q4.size() && origin.size() == d_q4.size() && in.max_disparity >= 1);
  const auto hole = [&](int y, int x) { return d_q4.at(y, x) == Disparity::kNone; };
  Image<int> region(d_q4.size());
  for (int y = 0; y < region.height(); ++y) std::fill_n(region.row(y), region.width(), 0);
  std::vector<Pixels> regions;
  for (int y = 0; y < d_q4.height(); ++y)
    for (int x = 0; x < d_q4.width(); ++x)
      if (region.at(y, x) == 0 && is_flat(in.gray, y, x))
        regions.push_back(region_of(in.gray, y, x, static_cast<int>(regions.size()) + 1, region));
  for (const Pixels& pixels : regions) {
    const auto holes = std::count_if(pixels.begin(), pixels.end(), [&](const auto& p) { return hole(p.first, p.second); });
    if (pixels.size() < In::kFewestPixels || static_cast<std::size_t>(In::kHolesOf * holes) < pixels.size()) continue;
    std::vector<PlanePoint> points;
    for (const auto& [y, x] : pixels)
      if (!hole(y, x) && is_inner(in.gray, region, y, x))
        points.push_back({static_cast<std::uint16_t>(y), static_cast<std::uint16_t>(x), d_q4.at(y, x)});
    RegionPlane plane;
    if (!region_plane(points, plane)) continue;
    for (const auto& [y, x] : pixels) {
      const int d = plane.d_q4(y, x);
      if (!hole(y, x) || d < 0 || d > 16 * (in.max_disparity - 1)) continue;
      d_q4.at(y, x) = static_cast<std::uint16_t>(d);
      origin.at(y, x) = static_cast<std::uint8_t>(Origin::kFilled);
    }
  }
}

}  // namespace duo::ref
