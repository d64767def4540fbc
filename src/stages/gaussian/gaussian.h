// Gaussian blur: attenuates additive noise before resampling.
#pragma once

#include <cstdint>

#include "core/pool.h"
#include "duoptic/image.h"

namespace duo {

// Separable 5x5 binomial filter (1 4 6 4 1) / 16, sigma 1 px, rounded once.
//
// Shape    src and dst H x W, not the same memory
// Border   the picture continues by its edge pixels
// Threads  rows are independent
// Exact    ref, simd and vk agree bit for bit: both sums fit 16 bits (255 * 256 + 128 < 65536)
// Source   thesis step 1; the binomial kernel as in Burt, Adelson, "The Laplacian pyramid", 1983
namespace ref {
void gaussian5x5(View<const std::uint8_t> src, View<std::uint8_t> dst);
}
namespace simd {
void gaussian5x5(Pool& pool, View<const std::uint8_t> src, View<std::uint8_t> dst);
}

}  // namespace duo
