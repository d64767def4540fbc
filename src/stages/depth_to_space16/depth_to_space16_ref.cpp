#include "stages/depth_to_space16/depth_to_space16.h"

#include <algorithm>

#include "core/check.h"

namespace duo::ref {

void depth_to_space16(ConstTensor16 x, Tensor16 y) {
  DUO_CHECK(y.width() == 2 * x.width() && y.height() == 2 * x.height() && x.channels() == 4 * y.channels());
  for (int oy = 0; oy < y.height(); ++oy)
    for (int ox = 0; ox < y.width(); ++ox)
      std::copy_n(x.pixel(oy / 2, ox / 2) + (2 * (oy % 2) + ox % 2) * y.channels(), y.channels(), y.pixel(oy, ox));
}

}  // namespace duo::ref
