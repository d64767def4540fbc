// The sum of two layers' results in 16-bit integers.
#pragma once

#include "core/pool.h"
#include "core/tensor.h"

namespace duo {

/// How two results with different steps come together.
struct Add16 {
  int left_a = 0, left_b = 0;  // 0 .. 14: shifts that bring both to one step
  int shift = 0;               // 0 .. 15: from there to the result's step
  Range16 range;
};

// y = range.clamp((a * 2^left_a + b * 2^left_b + half) >> shift) with half = 2^shift / 2, rounded down.
//
// Shape    a and y H x W x C; b H x W of at most C channels: those that b lacks count as 0. y may be a
// Threads  pixels are independent
// Exact    ref, simd and vk agree bit for bit: the sum is below 2^30 + 2^14
namespace ref {
void add16(const Add16& layer, ConstTensor16 a, ConstTensor16 b, Tensor16 y);
}
namespace simd {
void add16(Pool& pool, const Add16& layer, ConstTensor16 a, ConstTensor16 b, Tensor16 y);
}

}  // namespace duo
