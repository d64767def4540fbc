// The largest of each 2x2 pixels.
#pragma once

#include "core/pool.h"
#include "core/tensor.h"

namespace duo {

// y[oy][ox][c] = the largest of x[2 oy .. 2 oy + 1][2 ox .. 2 ox + 1][c].
//
// Shape    x 2H x 2W x C, y H x W x C
// Threads  rows are independent
// Exact    ref, simd and vk agree bit for bit
namespace ref {
void maxpool2x16(ConstTensor16 x, Tensor16 y);
}
namespace simd {
void maxpool2x16(Pool& pool, ConstTensor16 x, Tensor16 y);
}

}  // namespace duo
