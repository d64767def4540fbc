// The depth of a target: order statistics over its pixels, for a single pixel may be missing or the background's.
#pragma once

#include <cstdint>

#include "core/pool.h"
#include "core/targets.h"

namespace duo {

// Count, median and quartiles of the disparities in an area: see DepthSample. Exact for every disparity, without a range to
// choose.
//
// Shape    d_q4 H x W
// Units    1/16 px
// Threads  rows are independent; counts do not depend on their order
// Exact    ref, simd and vk agree bit for bit
// Source   ours; the median as a location that up to half of the pixels cannot move (Huber, "Robust statistics", 1981). The
// simd
//          engine selects by two histograms, of the high bytes and then of the low bytes beside the wanted high ones
namespace ref {
DepthSample sample_depth(View<const std::uint16_t> d_q4, const Area& area);
}
namespace simd {
DepthSample sample_depth(Pool& pool, View<const std::uint16_t> d_q4, const Area& area);
}

}  // namespace duo
