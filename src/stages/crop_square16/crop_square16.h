// A turned square of a picture as the input of a network.
#pragma once

#include <cstdint>

#include "core/pool.h"
#include "core/tensor.h"
#include "duoptic/detector.h"

namespace duo {

/// What a pixel outside the picture is.
enum class Outside : std::uint8_t { kEdge, kBlack };

// y[i][j] = bilinear value of the picture, in 1/128, + `offset`. With N the side of y, k = 2j + 1 - N, l = 2i + 1 - N and (rx,
// ry) the region's vector to its right, all in 1/65536 px and each quotient rounded down:
//   px = 256 x_q8 + 256 k rx / N + 256 (-l ry) / N,  py = 256 y_q8 + 256 k ry / N + 256 l rx / N;
// fx and fy are the 7 bits of px and py below whole pixels; y = ((128 - fy) upper + fy lower + 64) >> 7 with
// upper = (128 - fx) p[0][0] + fx p[0][1], and lower likewise of the row below.
//
// Shape    picture H x W below 16384 a side, y N x N of 3 channels, N <= 1024; no corner of the region beyond 32768 px from
//          the picture's corner: |x_q8| and |y_q8| + |right_x_q8| + |right_y_q8| < 2^23
// Units    offset: added to 0 .. 32640, such that the result fits 16 bits
// Border   kEdge: the picture continues by its edge pixels; kBlack: by zeros
// Threads  rows are independent
// Exact    ref, simd and vk agree bit for bit
namespace ref {
void crop_square16(View<const Rgb8> picture, const TurnedSquare& region, Outside outside, int offset, Tensor16 y);
}
namespace simd {
void crop_square16(Pool& pool, View<const Rgb8> picture, const TurnedSquare& region, Outside outside, int offset, Tensor16 y);
}

}  // namespace duo
