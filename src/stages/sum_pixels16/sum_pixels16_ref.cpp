#include "stages/sum_pixels16/sum_pixels16.h"

#include "core/check.h"

namespace duo::ref {

void sum_pixels16(ConstTensor16 x, int shift, Tensor16 y) {
  DUO_CHECK(y.pixels() == 1 && x.channels() == y.channels() && shift <= 15 && x.pixels() <= 1 << shift);
  for (int c = 0; c < y.channels(); ++c) {
    std::int32_t sum = (1 << shift) / 2;
    for (int p = 0; p < x.pixels(); ++p) sum += x.pixel(p)[c];
    y.data()[c] = static_cast<std::int16_t>(sum >> shift);
  }
}

}  // namespace duo::ref
