#include "stages/maxpool2x16/maxpool2x16.h"

#include <algorithm>

#include "core/check.h"

namespace duo::ref {

void maxpool2x16(ConstTensor16 x, Tensor16 y) {
  DUO_CHECK(x.width() == 2 * y.width() && x.height() == 2 * y.height() && x.channels() == y.channels());
  for (int oy = 0; oy < y.height(); ++oy)
    for (int ox = 0; ox < y.width(); ++ox)
      for (int c = 0; c < y.channels(); ++c)
        y.pixel(oy, ox)[c] = std::max({x.pixel(2 * oy, 2 * ox)[c], x.pixel(2 * oy, 2 * ox + 1)[c],
                                       x.pixel(2 * oy + 1, 2 * ox)[c], x.pixel(2 * oy + 1, 2 * ox + 1)[c]});
}

}  // namespace duo::ref
