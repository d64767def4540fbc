// Smoothing that keeps edges: noise goes, steps larger than it stay.
#pragma once

#include <cstdint>

#include "core/pool.h"
#include "duoptic/image.h"

namespace duo {

/// Each pixel v becomes v + sum(w d) / sum(w), halves rounded up, over its 3x3 neighbourhood: d the difference to v,
/// w = max(0, range + 1 - |d|). Range 0 changes nothing.
///
/// Shape    src and dst H x W, not the same memory
/// Units    range in gray levels, 0 .. kMostBilateralRange: differences beyond it have no weight
/// Border   the picture continues by its edge pixels
/// Threads  rows are independent
/// Exact    ref, simd and vk agree bit for bit: w d is at most 101^2 / 4 = 2550 and the sum of eight fits 16 bits; a quotient
/// of
///          integers below 2^17 rounded down is the same in 32-bit floating point
/// Source   Tomasi, Manduchi, "Bilateral filtering for gray and color images", 1998, with a triangle as its range kernel
constexpr int kMostBilateralRange = 100;
namespace ref {
void bilateral(View<const std::uint8_t> src, int range, View<std::uint8_t> dst);
}
namespace simd {
void bilateral(Pool& pool, View<const std::uint8_t> src, int range, View<std::uint8_t> dst);
}

/// One pixel of it.
std::uint8_t bilateral_at(View<const std::uint8_t> src, int range, int y, int x);

}  // namespace duo
