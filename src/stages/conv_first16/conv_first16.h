// The first convolution of a network in 16-bit integers: 3x3 pixels of three channels, every second pixel.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "core/pool.h"
#include "core/tensor.h"

namespace duo {

inline constexpr int kFirstTaps = 27;  // 3 rows of 3 pixels of 3 channels

/// What the first convolution has learnt; the memory is the network's.
struct ConvFirst16 {
  int outputs = 0;
  int pad_top = 0, pad_left = 0;          // 0 or 1: rows and columns of zeros before the first
  std::span<const std::int16_t> weights;  // outputs x 27, a window row by row, channels side by side; none is -32768
  std::span<const std::int32_t> bias;     // one an output; holds the half of 2^shift that rounds
  std::span<const std::uint8_t> shift;    // one an output, 0 .. 31
  Range16 range;
  std::span<const std::int32_t>
      packed{};  // what pack() made of the above; simd and vk read only this, the border and the range
};

/// Outputs in a block of a packed layer, and words of a block.
inline constexpr int kFirstBlock = 16, kFirstPairs = 15, kFirstBlockWords = kFirstBlock * (2 + kFirstPairs);
std::size_t packed_words(const ConvFirst16& layer);
/// The layer in the order of lanes: a block holds 16 biases, 16 shifts and, for each of the window's rows, 5 times 16 pairs of
/// weights, the even input's in the low half of a word; the tenth weight of a row is 0, and so is what the last block lacks.
void pack(const ConvFirst16& layer, std::span<std::int32_t> packed);

/// Whether no sum leaves 32 bits whatever the inputs are within `x`; the precondition of the stage. `x` has 0.
bool sums_fit(const ConvFirst16& layer, Range16 x);

// sum = over the window, x[oy * 2 - pad_top + i][ox * 2 - pad_left + j][c] w[n][i][j][c];
// y[oy][ox][n] = range.clamp((sum + bias[n]) >> shift[n]).
//
// Shape    x H x W of 3 channels, y H / 2 x W / 2 of `outputs` channels; H and W even
// Border   zeros
// Threads  rows and outputs are independent
// Exact    ref, simd and vk agree bit for bit: sum + bias fits 32 bits (sums_fit), what lies between may wrap
// Source   as in matmul16.h
namespace ref {
void conv_first16(const ConvFirst16& layer, ConstTensor16 x, Tensor16 y);
}
namespace simd {
void conv_first16(Pool& pool, const ConvFirst16& layer, ConstTensor16 x, Tensor16 y);
}

}  // namespace duo
