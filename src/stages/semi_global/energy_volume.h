// What semi-global matching knows of every disparity, not of the winner alone: a volume that surfaces are fitted to.
#pragma once

#include <cstdint>
#include <vector>

#include "core/pool.h"
#include "stages/semi_global/semi_global.h"

namespace duo {

/// A byte for each pixel and disparity. That of disparity d lies at cell(y, x)[lanes() - 1 - d]. Cells are readable, and hold
/// anything, for kBefore columns left and kAfter columns right of the picture; three more bytes around each cell are, too.
class EnergyVolume {
 public:
  static constexpr int kBefore = 16, kAfter = 48;

  EnergyVolume(Size size, int max_disparity)
      : size_(size),
        max_disparity_(max_disparity),
        lanes_(simd::SemiGlobalScratch::padding(max_disparity)),
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

/// Energy of each disparity of the left view: E = min(C, kMostCost) + s + s / 2 (rounded down), s = min(S - least S of the
/// pixel, kMostPaths); C and S as SemiGlobal defines them. At most kMost. The pixel's own cost says what fits here, the paths
/// what fits to the surfaces around.
///
/// Shape   planes and volume H x W; right planes padded by SemiGlobalScratch::padding() columns; paths from the left, the right
///         and above alone
/// Exact   ref and simd agree bit for bit, with any number of threads
struct EnergyOf {
  static constexpr int kMostCost = 25, kMostPaths = 40, kMost = kMostCost + kMostPaths + kMostPaths / 2;
  static int energy(int cost, int sum, int least_sum) {
    const int s = std::min(sum - least_sum, kMostPaths);
    return std::min(cost, kMostCost) + s + s / 2;
  }
};

namespace ref {
void energy_volume(const SemiGlobal& in, EnergyVolume& out);
}

namespace simd {
/// Each thread's rows of costs and path costs.
struct EnergyVolumeScratch {
  EnergyVolumeScratch(Size size, int max_disparity, int threads);
  struct Thread {
    Image<std::uint8_t> costs;   // [pixel][disparity]
    Image<std::uint8_t> along;   // [2][disparity]
    Image<std::uint8_t> down;    // [pixel][disparity]: path costs of the row before, then of this one
    Image<std::uint8_t> minima;  // [pixel]
  };
  std::vector<Thread> threads;
};
void energy_volume(Pool& pool, const SemiGlobal& in, EnergyVolumeScratch& scratch, EnergyVolume& out);
}  // namespace simd

}  // namespace duo
