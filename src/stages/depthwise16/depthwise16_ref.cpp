#include <limits>

#include "core/check.h"
#include "stages/depthwise16/depthwise16.h"

namespace duo {

bool sums_fit(const Depthwise16& layer, Range16 x) {
  const int taps = layer.window * layer.window;
  for (int c = 0; c < layer.channels; ++c) {
    std::int64_t positive = 0, negative = 0;
    for (int i = 0; i < taps; ++i) {
      const std::int64_t w = layer.weights[i * layer.channels + c];
      (w > 0 ? positive : negative) += w;
    }
    const std::int64_t least = layer.bias[c] + x.least(positive, negative), most = layer.bias[c] + x.most(positive, negative);
    if (least < std::numeric_limits<std::int32_t>::min() || most > std::numeric_limits<std::int32_t>::max()) return false;
  }
  return true;
}

namespace ref {

void depthwise16(const Depthwise16& layer, ConstTensor16 x, Tensor16 y) {
  depthwise16(layer, x, y, 0, y.height(), 0, layer.channels);
}

void depthwise16(const Depthwise16& layer, ConstTensor16 x, Tensor16 y, int oy_begin, int oy_end, int c_begin, int c_end) {
  DUO_CHECK(x.channels() == layer.channels && y.channels() == layer.channels);
  for (int oy = oy_begin; oy < oy_end; ++oy)
    for (int ox = 0; ox < y.width(); ++ox)
      for (int c = c_begin; c < c_end; ++c) {
        std::int64_t sum = layer.bias[c];
        for (int i = 0; i < layer.window; ++i)
          for (int j = 0; j < layer.window; ++j) {
            const int iy = oy * layer.stride - layer.pad_top + i, ix = ox * layer.stride - layer.pad_left + j;
            if (iy < 0 || iy >= x.height() || ix < 0 || ix >= x.width()) continue;
            sum += x.pixel(iy, ix)[c] * layer.weights[(i * layer.window + j) * layer.channels + c];
          }
        y.pixel(oy, ox)[c] = layer.range.clamp(static_cast<std::int32_t>(sum >> layer.shift[c]));
      }
}

}  // namespace ref
}  // namespace duo
