// Colour to gray: the matchers work on one channel.
#pragma once

#include <cstdint>

#include "core/pool.h"
#include "duoptic/image.h"

namespace duo {

// Luma (77 R + 150 G + 29 B + 128) >> 8.
//
// Shape    src and dst H x W
// Border   none
// Threads  rows are independent
// Exact    ref, simd and vk agree bit for bit; white stays 255 because the weights sum to 256
// Source   ITU-R BT.601 weights in 8 bits
namespace ref {
void gray(View<const Rgb8> src, View<std::uint8_t> dst);
}
namespace simd {
void gray(Pool& pool, View<const Rgb8> src, View<std::uint8_t> dst);
}

}  // namespace duo
