#include "engines/filling.h"

#include "stages/fill/fill.h"

namespace duo {

Filling::Filling(Size size, int max_disparity) : max_disparity_(max_disparity), regions_(size), unfilled_(size) {}

void Filling::fill(Pool& pool, View<const std::uint8_t> left, Disparity& disparity) {
  simd::fill_regions(pool, {left, max_disparity_}, regions_, disparity.d_q4, disparity.origin);
  disparity.d_q4.swap(unfilled_);
  simd::fill(pool, unfilled_, max_disparity_, disparity.origin, disparity.d_q4);
}

}  // namespace duo
