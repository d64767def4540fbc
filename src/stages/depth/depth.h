// Disparity to depth.
#pragma once

#include <cstdint>

#include "core/pool.h"
#include "duoptic/frame.h"

namespace duo {

// z = focal * baseline / d, rounded to whole millimetres; 0 where there is no disparity, where d is 0 (infinitely far) or
// where z does not fit 16 bits (beyond 65.5 m).
//
// Shape    src and dst H x W
// Units    src 1/16 px, dst mm; focal_baseline_px_mm = focal_px * baseline_mm
// Threads  rows are independent
// Exact    ref, simd and vk agree bit for bit: one IEEE single division, one addition, one truncation
// Source   pinhole geometry of the rectified pair
namespace ref {
void depth(View<const std::uint16_t> d_q4, float focal_baseline_px_mm, View<std::uint16_t> depth_mm);
}
namespace simd {
void depth(Pool& pool, View<const std::uint16_t> d_q4, float focal_baseline_px_mm, View<std::uint16_t> depth_mm);
}

}  // namespace duo
