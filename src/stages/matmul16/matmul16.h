// The 1x1 convolution and the fully connected layer of a network in 16-bit integers.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "core/pool.h"
#include "core/tensor.h"

namespace duo {

/// So many inputs are summed before a sum is folded into the total.
inline constexpr int kMatmulChunk = 128;

/// What a 1x1 convolution has learnt; the memory is the network's.
struct Matmul16 {
  int inputs = 0, outputs = 0;            // inputs even: lanes take them in pairs
  std::span<const std::int16_t> weights;  // outputs x inputs, those of an output side by side; none is -32768
  std::span<const std::int32_t> bias;     // one an output; holds the half of 2^shift that rounds
  std::span<const std::uint8_t> shift;    // one an output, 0 .. 31
  int fold = 0;                           // 0 .. 15; 0 where there is one chunk
  Range16 range;
  std::span<const std::int32_t> packed{};  // what pack() made of the above; simd and vk read only this and the range
};

/// Outputs in a block of a packed layer.
inline constexpr int kMatmulBlock = 16;
/// Words of a packed block, and of all.
std::size_t packed_block(const Matmul16& layer);
std::size_t packed_words(const Matmul16& layer);
/// The layer in the order of lanes: a block holds 16 biases, 16 shifts and, for each pair of inputs, 16 pairs of weights, the
/// even input's in the low half of a word. What the last block lacks is 0.
void pack(const Matmul16& layer, std::span<std::int32_t> packed);

/// Whether no sum leaves 32 bits whatever the inputs are within `x`; the precondition of the stage.
bool sums_fit(const Matmul16& layer, Range16 x);

// For each pixel p and output n, with half = 2^fold / 2 rounded down:
// total = sum over chunks of (sum over the chunk's 128 inputs k of x[p][k] w[n][k] + half) >> fold; the last chunk is the rest;
// y[p][n] = range.clamp((total + bias[n]) >> shift[n]).
//
// Shape    x any picture of `inputs` channels, y as many pixels of `outputs` channels; fully connected is one pixel
// Units    powers of two: a shift is all that lies between the steps of x, w and y
// Threads  pixels and outputs are independent
// Exact    ref, simd and vk agree bit for bit: a chunk's sum and total + bias fit 32 bits (sums_fit), what lies between may
//          wrap, so that any order of adding is right; shifts are arithmetic
// Source   Jacob et al., "Quantization and training of neural networks for efficient integer-arithmetic-only inference",
//          2018; here 16 bits and shifts instead of 8 bits and multipliers, and sums of more than 128 terms folded, which
//          leaves weights their bits
namespace ref {
void matmul16(const Matmul16& layer, ConstTensor16 x, Tensor16 y);
}
namespace simd {
void matmul16(Pool& pool, const Matmul16& layer, ConstTensor16 x, Tensor16 y);
}

}  // namespace duo
