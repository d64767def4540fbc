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
