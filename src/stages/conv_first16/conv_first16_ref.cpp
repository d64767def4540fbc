#include <algorithm>
#include <limits>

#include "core/check.h"
#include "stages/conv_first16/conv_first16.h"

namespace duo {

bool sums_fit(const ConvFirst16& layer, Range16 x) {
  for (int n = 0; n < layer.outputs; ++n) {
    std::int64_t positive = 0, negative = 0;
    for (int i = 0; i < kFirstTaps; ++i) {
      const std::int64_t w = layer.weights[n * kFirstTaps + i];
      (w > 0 ? positive : negative) += w;
    }
    const std::int64_t least = layer.bias[n] + x.least(positive, negative), most = layer.bias[n] + x.most(positive, negative);
    if (least < std::numeric_limits<std::int32_t>::min() || most > std::numeric_limits<std::int32_t>::max()) return false;
  }
  return true;
}

std::size_t packed_words(const ConvFirst16& layer) {
  return std::size_t{kFirstBlockWords} * ((layer.outputs + kFirstBlock - 1) / kFirstBlock);
}

void pack(const ConvFirst16& layer, std::span<std::int32_t> packed) {
  DUO_CHECK(packed.size() == packed_words(layer));
  std::fill(packed.begin(), packed.end(), 0);
  for (int n = 0; n < layer.outputs; ++n) {
    std::int32_t* word = packed.data() + n / kFirstBlock * kFirstBlockWords + n % kFirstBlock;
    word[0] = layer.bias[n];
    word[kFirstBlock] = layer.shift[n];
    for (int k = 0; k < kFirstPairs; ++k) {
      const std::int16_t* w = layer.weights.data() + n * kFirstTaps + k / 5 * 9 + k % 5 * 2;
      const std::uint32_t low = static_cast<std::uint16_t>(w[0]), high = k % 5 == 4 ? 0 : static_cast<std::uint16_t>(w[1]);
      word[(2 + k) * kFirstBlock] = static_cast<std::int32_t>(low | high << 16);
    }
  }
}

namespace ref {

void conv_first16(const ConvFirst16& layer, ConstTensor16 x, Tensor16 y) {
  DUO_CHECK(x.channels() == 3 && y.channels() == layer.outputs);
  DUO_CHECK(x.width() == 2 * y.width() && x.height() == 2 * y.height());
  for (int oy = 0; oy < y.height(); ++oy)
    for (int ox = 0; ox < y.width(); ++ox)
      for (int n = 0; n < layer.outputs; ++n) {
        std::int64_t sum = layer.bias[n];
        for (int i = 0; i < 3; ++i)
          for (int j = 0; j < 3; ++j) {
            const int iy = 2 * oy - layer.pad_top + i, ix = 2 * ox - layer.pad_left + j;
            if (iy < 0 || iy >= x.height() || ix < 0 || ix >= x.width()) continue;
            const std::int16_t* w = layer.weights.data() + n * kFirstTaps + 3 * (3 * i + j);
            for (int c = 0; c < 3; ++c) sum += x.pixel(iy, ix)[c] * w[c];
          }
        y.pixel(oy, ox)[n] = layer.range.clamp(static_cast<std::int32_t>(sum >> layer.shift[n]));
      }
}

}  // namespace ref
}  // namespace duo
