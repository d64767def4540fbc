// Energies of all disparities of a view, between the stage that works them out and the stage that fits planes to them.
#pragma once

#include <cstddef>
#include <cstdint>

#include "duoptic/image.h"

namespace duo {

/// A byte for each pixel and disparity. That of disparity d lies at cell(y, x)[lanes() - 1 - d]. Cells are readable, and hold
/// anything, for kBefore columns left and kAfter columns right of the picture; three more bytes around each cell are, too.
class EnergyVolume {
 public:
  static constexpr int kBefore = 16, kAfter = 48;

  EnergyVolume(Size size, int max_disparity)
      : size_(size),
        max_disparity_(max_disparity),
        lanes_((max_disparity + kLine - 1) / kLine * kLine),
        // An odd number of cache lines: the same disparity of neighbours does not share the cache's sets.
        stride_((lanes_ / kLine | 1) * kLine),
        cells_({(kBefore + size.width + kAfter) * stride_, size.height}) {}

  std::uint8_t* cell(int y, int x) { return cells_.row(y) + static_cast<std::ptrdiff_t>(kBefore + x) * stride_; }
  const std::uint8_t* cell(int y, int x) const { return cells_.row(y) + static_cast<std::ptrdiff_t>(kBefore + x) * stride_; }
  Size size() const { return size_; }
  int max_disparity() const { return max_disparity_; }
  int lanes() const { return lanes_; }
  int stride() const { return stride_; }  // bytes from a cell to the next one of the row

 private:
  static constexpr int kLine = 64;
  Size size_;
  int max_disparity_, lanes_, stride_;
  Image<std::uint8_t> cells_;
};

}  // namespace duo
