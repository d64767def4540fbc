// What semi-global matching knows of every disparity, not of the winner alone: a volume that surfaces are fitted to.
#pragma once

#include <cstdint>
#include <vector>

#include "core/pool.h"
#include "stages/semi_global/semi_global.h"
#include "stages/types/energy_volume.h"

namespace duo {

/// Energy of each disparity of the left view: E = min(C, kMostCost) + s + s / 2 (rounded down), s = min(S - least S of the
/// pixel, kMostPaths); C and S as SemiGlobal defines them. At most kMost. The pixel's own cost says what fits here, the paths
/// what fits to the surfaces around.
///
/// Shape   planes and volume H x W; right planes padded by SemiGlobalScratch::padding() columns; paths from the left, the right
///         and above alone
/// Exact   ref and simd agree bit for bit, with any number of threads
struct EnergyOf {
  static constexpr int kMostCost = 25, kMostPaths = 55, kMost = kMostCost + kMostPaths + kMostPaths / 2;
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
