// Connected regions of cells, cut where depth steps.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "trackers/arm/grid.h"

namespace duo::arm {

/// The cells of one region; valid until the next find().
struct Region {
  std::span<const int> cells;
  double area_m2 = 0;
  Vec3 mean;
};

class Regions {
 public:
  Regions() = default;
  explicit Regions(const Grid& grid);

  /// Regions of at least six set cells (all must have depth), by their first cell in reading order. Neighbours up to two cells
  /// apart belong together where their depth differs by less than step_m plus the grain of disparity.
  std::span<const Region> find(const Grid& grid, const std::vector<std::uint8_t>& mask, double step_m);

 private:
  std::vector<Region> found_;
  std::vector<int> queue_;  // the cells of all regions, one after the other
  std::vector<std::uint8_t> open_;
};

}  // namespace duo::arm
