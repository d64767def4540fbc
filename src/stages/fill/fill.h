// Fills holes from the background.
#pragma once

#include <cstdint>

#include "core/pool.h"
#include "duoptic/frame.h"

namespace duo {

// A hole takes the smaller of the nearest measured disparities to its left and right on the row: what is hidden from one
// camera belongs to the surface behind. Rows without any measurement stay holes. Filled pixels are marked Origin::kFilled.
//
// Shape    d_q4 and origin H x W, changed in place; vk: at most 16384 wide
// Units    1/16 px
// Threads  rows are independent
// Exact    ref, simd and vk agree bit for bit
// Source   the row-minimum fill of the Middlebury evaluations (Scharstein, Szeliski 2002)
//
// mark_measured: origin is kMeasured where there is a disparity, else kNone; it comes first.
namespace ref {
void mark_measured(View<const std::uint16_t> d_q4, View<std::uint8_t> origin);
void fill(View<std::uint16_t> d_q4, View<std::uint8_t> origin);
}
namespace simd {
void mark_measured(Pool& pool, View<const std::uint16_t> d_q4, View<std::uint8_t> origin);
void fill(Pool& pool, View<std::uint16_t> d_q4, View<std::uint8_t> origin);
}

}  // namespace duo
