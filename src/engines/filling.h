// Holes filled on the CPU, whatever found the disparities.
#pragma once

#include "core/pool.h"
#include "duoptic/frame.h"
#include "stages/fill_regions/fill_regions.h"

namespace duo {

/// The memory of filling, for pictures of one size; allocates nothing once it is there.
class Filling {
 public:
  Filling(Size size, int max_disparity);
  /// Fills what is marked as a hole.
  void fill(Pool& pool, View<const std::uint8_t> left, Disparity& disparity);

 private:
  int max_disparity_;
  simd::FillRegionsScratch regions_;
  Image<std::uint16_t> unfilled_;
};

}  // namespace duo
