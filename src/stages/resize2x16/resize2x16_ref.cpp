#include "stages/resize2x16/resize2x16.h"

#include <algorithm>

#include "core/check.h"

namespace duo::ref {

void resize2x16(ConstTensor16 x, Tensor16 y) {
  DUO_CHECK(y.width() == 2 * x.width() && y.height() == 2 * x.height() && x.channels() == y.channels());
  for (int oy = 0; oy < y.height(); ++oy)
    for (int ox = 0; ox < y.width(); ++ox) {
      const int near_y = oy / 2, far_y = std::clamp(oy % 2 ? near_y + 1 : near_y - 1, 0, x.height() - 1);
      const int near_x = ox / 2, far_x = std::clamp(ox % 2 ? near_x + 1 : near_x - 1, 0, x.width() - 1);
      for (int c = 0; c < y.channels(); ++c) {
        const int sum = 9 * x.pixel(near_y, near_x)[c] + 3 * x.pixel(near_y, far_x)[c] + 3 * x.pixel(far_y, near_x)[c] +
                        x.pixel(far_y, far_x)[c];
        y.pixel(oy, ox)[c] = static_cast<std::int16_t>((sum + 8) >> 4);
      }
    }
}

}  // namespace duo::ref
