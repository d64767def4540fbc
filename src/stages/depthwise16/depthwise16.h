// The depthwise convolution of a network in 16-bit integers: each channel has a window of its own.
#pragma once

#include <cstdint>
#include <span>

#include "core/pool.h"
#include "core/tensor.h"

namespace duo {

/// What a depthwise convolution has learnt; the memory is the network's.
struct Depthwise16 {
  int channels = 0;
  int window = 3;                 // 3 or 5
  int stride = 1;                 // 1 or 2
  int pad_top = 0, pad_left = 0;  // 0 .. window - 1: rows and columns of zeros before the first
  std::span<const std::int16_t>
      weights;  // window x window x channels, those of a place in the window side by side; none is -32768
  std::span<const std::int32_t> bias;   // one a channel; holds the half of 2^shift that rounds
  std::span<const std::uint8_t> shift;  // one a channel, 0 .. 31
  Range16 range;
};

/// Whether no sum leaves 32 bits whatever the inputs are within `x`; the precondition of the stage. `x` has 0.
bool sums_fit(const Depthwise16& layer, Range16 x);

// sum = over the window, x[oy * stride - pad_top + i][ox * stride - pad_left + j][c] w[i][j][c];
// y[oy][ox][c] = range.clamp((sum + bias[c]) >> shift[c]).
//
// Shape    x and y any sizes of `channels` channels; y says how many rows and columns there are
// Border   zeros, as many as are needed on every side
// Threads  rows and channels are independent
// Exact    ref, simd and vk agree bit for bit: sum + bias fits 32 bits (sums_fit), what lies between may wrap
// Source   Howard et al., "MobileNets", 2017, in integers as in matmul16.h
namespace ref {
void depthwise16(const Depthwise16& layer, ConstTensor16 x, Tensor16 y);
/// Of y only rows oy_begin .. oy_end of channels c_begin .. c_end.
void depthwise16(const Depthwise16& layer, ConstTensor16 x, Tensor16 y, int oy_begin, int oy_end, int c_begin, int c_end);
}  // namespace ref
namespace simd {
void depthwise16(Pool& pool, const Depthwise16& layer, ConstTensor16 x, Tensor16 y);
}

/// Channels that simd takes together.
inline constexpr int kDepthwiseGroup = 32;

}  // namespace duo
