#include "trackers/arm/regions.h"

#include <cmath>

namespace duo::arm {

Regions::Regions(const Grid& grid) {
  found_.reserve(static_cast<std::size_t>(grid.size()) / 6 + 1);
  queue_.resize(static_cast<std::size_t>(grid.size()));
  open_.resize(static_cast<std::size_t>(grid.size()));
}

std::span<const Region> Regions::find(const Grid& grid, const std::vector<std::uint8_t>& mask, double step_m) {
  constexpr int kLeastCells = 6;
  constexpr int kSteps[8][2] = {{1, 0}, {-1, 0}, {0, 1}, {0, -1}, {2, 0}, {-2, 0}, {0, 2}, {0, -2}};
  constexpr double kGrainPx = 0.6;  // of the full picture
  const double grain = kGrainPx / (grid.step * grid.camera.focal_px * grid.camera.baseline_m);
  found_.clear();
  open_ = mask;
  std::size_t end = 0;
  for (int seed = 0; seed < grid.size(); ++seed) {
    if (!open_[static_cast<std::size_t>(seed)]) continue;
    const std::size_t begin = end;
    Region region;
    queue_[end++] = seed;
    open_[static_cast<std::size_t>(seed)] = 0;
    for (std::size_t next = begin; next < end; ++next) {
      const int i = queue_[next], x = i % grid.width, y = i / grid.width;
      const Vec3 p = grid.point(i);
      region.mean = region.mean + p;
      region.area_m2 += grid.area_m2(p.z);
      const double reach_m = step_m + grain * p.z * p.z;
      for (const auto& [dx, dy] : kSteps) {
        if (!grid.contains(x + dx, y + dy)) continue;
        const int j = grid.at(x + dx, y + dy);
        if (!open_[static_cast<std::size_t>(j)] || !(std::abs(grid.z(j) - p.z) < reach_m)) continue;
        open_[static_cast<std::size_t>(j)] = 0;
        queue_[end++] = j;
      }
    }
    if (end - begin < kLeastCells) {
      end = begin;
      continue;
    }
    region.cells = {queue_.data() + begin, end - begin};
    region.mean = (1.0 / static_cast<double>(end - begin)) * region.mean;
    found_.push_back(region);
  }
  return found_;
}

}  // namespace duo::arm
