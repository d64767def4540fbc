#include "stages/add16/add16.h"

#include "core/check.h"

namespace duo::ref {

void add16(const Add16& layer, ConstTensor16 a, ConstTensor16 b, Tensor16 y) {
  DUO_CHECK(a.size() == y.size() && b.size() == y.size());
  DUO_CHECK(a.channels() == y.channels() && b.channels() <= y.channels());
  const std::int32_t half = (1 << layer.shift) / 2;
  for (int p = 0; p < y.pixels(); ++p)
    for (int c = 0; c < y.channels(); ++c) {
      const std::int32_t from_b = c < b.channels() ? b.pixel(p)[c] * (1 << layer.left_b) : 0;
      y.pixel(p)[c] = layer.range.clamp((a.pixel(p)[c] * (1 << layer.left_a) + from_b + half) >> layer.shift);
    }
}

}  // namespace duo::ref
