#include <algorithm>
#include <limits>

#include "core/check.h"
#include "stages/matmul16/matmul16.h"

namespace duo {
namespace {

bool fits_int32(std::int64_t least, std::int64_t most) {
  return least >= std::numeric_limits<std::int32_t>::min() && most <= std::numeric_limits<std::int32_t>::max();
}

}  // namespace

bool sums_fit(const Matmul16& layer, Range16 x) {
  const std::int64_t half = (std::int64_t{1} << layer.fold) / 2;
  for (int n = 0; n < layer.outputs; ++n) {
    const std::int16_t* w = layer.weights.data() + static_cast<std::ptrdiff_t>(n) * layer.inputs;
    std::int64_t least_total = layer.bias[n], most_total = layer.bias[n];
    for (int begin = 0; begin < layer.inputs; begin += kMatmulChunk) {
      std::int32_t positive = 0, negative = 0;  // 128 weights of 16 bits
      for (int k = begin; k < std::min(begin + kMatmulChunk, layer.inputs); ++k) {
        positive += std::max<std::int32_t>(w[k], 0);
        negative += std::min<std::int32_t>(w[k], 0);
      }
      const std::int64_t least = half + x.least(positive, negative), most = half + x.most(positive, negative);
      if (!fits_int32(least, most)) return false;
      least_total += least >> layer.fold;
      most_total += most >> layer.fold;
    }
    if (!fits_int32(least_total, most_total)) return false;
  }
  return true;
}

std::size_t packed_block(const Matmul16& layer) { return kMatmulBlock * (2 + layer.inputs / std::size_t{2}); }

std::size_t packed_words(const Matmul16& layer) {
  return packed_block(layer) * ((layer.outputs + kMatmulBlock - 1) / kMatmulBlock);
}

void pack(const Matmul16& layer, std::span<std::int32_t> packed) {
  DUO_CHECK(layer.inputs % 2 == 0 && packed.size() == packed_words(layer));
  std::fill(packed.begin(), packed.end(), 0);
  for (int n = 0; n < layer.outputs; ++n) {
    const std::int16_t* w = layer.weights.data() + static_cast<std::ptrdiff_t>(n) * layer.inputs;
    std::int32_t* word = packed.data() + n / kMatmulBlock * packed_block(layer) + n % kMatmulBlock;
    word[0] = layer.bias[n];
    word[kMatmulBlock] = layer.shift[n];
    for (int k = 0; k < layer.inputs; k += 2) {
      const std::uint32_t low = static_cast<std::uint16_t>(w[k]), high = static_cast<std::uint16_t>(w[k + 1]);
      word[(2 + k / 2) * kMatmulBlock] = static_cast<std::int32_t>(low | high << 16);
    }
  }
}

namespace ref {

void matmul16(const Matmul16& layer, ConstTensor16 x, Tensor16 y) {
  DUO_CHECK(x.channels() == layer.inputs && y.channels() == layer.outputs && x.pixels() == y.pixels());
  const std::int32_t half = (1 << layer.fold) / 2;
  for (int p = 0; p < x.pixels(); ++p)
    for (int n = 0; n < layer.outputs; ++n) {
      const std::int16_t* w = layer.weights.data() + static_cast<std::ptrdiff_t>(n) * layer.inputs;
      std::int64_t total = layer.bias[n];
      for (int begin = 0; begin < layer.inputs; begin += kMatmulChunk) {
        std::int64_t sum = half;
        for (int k = begin; k < std::min(begin + kMatmulChunk, layer.inputs); ++k) sum += x.pixel(p)[k] * w[k];
        total += sum >> layer.fold;
      }
      y.pixel(p)[n] = layer.range.clamp(static_cast<std::int32_t>(total >> layer.shift[n]));
    }
}

}  // namespace ref
}  // namespace duo
