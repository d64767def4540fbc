// Median 3x3: removes salt-and-pepper noise; each result is one of its inputs.
#pragma once

#include <cstdint>

#include "core/pool.h"
#include "duoptic/image.h"

namespace duo {

// Median of the 3x3 neighbourhood.
//
// Shape    src and dst H x W, same size, not the same memory
// Units    any; Disparity::kNone sorts as the largest value, so a hole with at least five known neighbours gets a value
// Border   the picture continues by its edge pixels
// Threads  rows are independent
// Exact    ref, simd and vk agree bit for bit
// Source   Huang, Yang, Tang, "A fast two-dimensional median filtering algorithm", 1979 (the definition); the simd engine
//          sorts columns once and takes the median of (max of lows, median of middles, min of highs)
namespace ref {
void median3x3(View<const std::uint8_t> src, View<std::uint8_t> dst);
void median3x3(View<const std::uint16_t> src, View<std::uint16_t> dst);
}  // namespace ref

namespace simd {
void median3x3(Pool& pool, View<const std::uint8_t> src, View<std::uint8_t> dst);
void median3x3(Pool& pool, View<const std::uint16_t> src, View<std::uint16_t> dst);
}  // namespace simd

}  // namespace duo
