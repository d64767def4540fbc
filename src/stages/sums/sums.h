// What is left of a target's pixels: count, moments, disparity, hue; and its outermost pixels.
#pragma once

#include <cstdint>
#include <optional>

#include "core/pool.h"
#include "core/targets.h"

namespace duo {

/// Sums over the pixels of an area: see AreaSums.
///
/// Shape    hue and d_q4 H x W; either may be empty = not summed
/// Units    as in AreaSums: 64 bits hold the sums of any picture up to 32768 x 32768
/// Threads  rows are independent; sums of integers do not depend on their order
/// Exact    ref, simd and vk agree bit for bit
/// Source   ours; moments after Hu, "Visual pattern recognition by moment invariants", 1962; hue as a mean direction (Mardia,
///          "Statistics of directional data", 1972), because plain means break at red
struct Sums {
  Size size;  // of the picture
  Area area;
  View<const std::uint8_t> hue = {};
  View<const std::uint16_t> d_q4 = {};
};

/// The hue whose direction fits the sums best, the lowest where several do; none for an area without a mean direction.
std::optional<std::uint8_t> mean_hue(const AreaSums& sums);

// Outermost pixels of an area, first in reading order where several are; none in an empty area.
//   farthest_pixel: at the greatest distance from `from`, which may lie anywhere. Seen from the elbow that is the hand's end.
//   extreme_pixel:  greatest x along_x + y along_y.
//
// Units    px; |from| and |along| below 2^15
// Threads  rows are independent
// Exact    ref, simd and vk agree bit for bit
// Source   ours; on convex measures a row's outermost pixel is its first or its last one
namespace ref {
AreaSums sums(const Sums& in);
Pixel farthest_pixel(Size size, const Area& area, Pixel from);
Pixel extreme_pixel(Size size, const Area& area, int along_x, int along_y);
}  // namespace ref
namespace simd {
AreaSums sums(Pool& pool, const Sums& in);
Pixel farthest_pixel(Pool& pool, Size size, const Area& area, Pixel from);
Pixel extreme_pixel(Pool& pool, Size size, const Area& area, int along_x, int along_y);
}  // namespace simd

}  // namespace duo
