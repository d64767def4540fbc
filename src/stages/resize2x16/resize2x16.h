// Twice as many rows and columns, interpolated.
#pragma once

#include "core/pool.h"
#include "core/tensor.h"

namespace duo {

// Bilinear with the centres of pixels at halves: each result lies a quarter away from the nearest input, so
// y = (9 near + 3 beside + 3 above or below + across + 8) >> 4.
//
// Shape    x H x W x C, y 2H x 2W x C
// Border   the picture continues by its edge pixels
// Threads  rows are independent
// Exact    ref, simd and vk agree bit for bit
namespace ref {
void resize2x16(ConstTensor16 x, Tensor16 y);
}
namespace simd {
void resize2x16(Pool& pool, ConstTensor16 x, Tensor16 y);
}

}  // namespace duo
