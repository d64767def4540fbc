// One step of the averaging pyramid.
#pragma once

#include <cstdint>

#include "core/pool.h"
#include "duoptic/image.h"

namespace duo {

/// Size of the next coarser level: half, rounded up.
inline Size half_of(Size size) { return {(size.width + 1) / 2, (size.height + 1) / 2}; }

// Mean of 2x2 pixels, (a + b + c + d + 2) >> 2; halve_inside: 255 where all four are inside, else 0.
//
// Shape    src H x W, dst (H+1)/2 x (W+1)/2
// Border   an odd last row or column is used twice
// Threads  rows are independent
// Exact    ref, simd and vk agree bit for bit
// Source   thesis step 2: each level averages a neighbourhood of the one before
namespace ref {
void halve(View<const std::uint8_t> src, View<std::uint8_t> dst);
void halve_inside(View<const std::uint8_t> src, View<std::uint8_t> dst);
}  // namespace ref
namespace simd {
void halve(Pool& pool, View<const std::uint8_t> src, View<std::uint8_t> dst);
void halve_inside(Pool& pool, View<const std::uint8_t> src, View<std::uint8_t> dst);
}  // namespace simd

}  // namespace duo
