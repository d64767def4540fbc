// Twice as many rows and columns of a quarter of the channels: channels become pixels.
#pragma once

#include "core/pool.h"
#include "core/tensor.h"

namespace duo {

// y[2 iy + i][2 ix + j][c] = x[iy][ix][(2 i + j) C + c] with C the channels of y.
//
// Shape    x H x W x 4C, y 2H x 2W x C
// Threads  rows are independent
// Exact    ref, simd and vk agree bit for bit: values are moved
namespace ref {
void depth_to_space16(ConstTensor16 x, Tensor16 y);
}
namespace simd {
void depth_to_space16(Pool& pool, ConstTensor16 x, Tensor16 y);
}

}  // namespace duo
