// The sum over a whole picture of each channel: a network's global mean, whose division the next layer's weights hold.
#pragma once

#include "core/pool.h"
#include "core/tensor.h"

namespace duo {

// y[c] = (sum over all pixels of x[p][c] + half) >> shift with half = 2^shift / 2, rounded down.
//
// Shape    x at most 2^15 pixels of C channels and at most 2^shift pixels, so that the result fits; y one pixel of C channels
// Threads  channels are independent
// Exact    ref, simd and vk agree bit for bit
namespace ref {
void sum_pixels16(ConstTensor16 x, int shift, Tensor16 y);
}
namespace simd {
void sum_pixels16(Pool& pool, ConstTensor16 x, int shift, Tensor16 y);
}

}  // namespace duo
