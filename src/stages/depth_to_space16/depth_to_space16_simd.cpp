#include <algorithm>

#include "core/check.h"
#include "core/tensor_parts.h"
#include "stages/depth_to_space16/depth_to_space16.h"

namespace duo::simd {

// Half of a pixel's channels become two pixels of a row: runs are copied, which needs no lanes.
void depth_to_space16(Pool& pool, ConstTensor16 x, Tensor16 y) {
  DUO_CHECK(y.width() == 2 * x.width() && y.height() == 2 * x.height() && x.channels() == 4 * y.channels());
  const int run = 2 * y.channels();
  each_tensor_row(pool, y, [&](int begin, int end) {
    for (int oy = begin; oy < end; ++oy)
      for (int ix = 0; ix < x.width(); ++ix) std::copy_n(x.pixel(oy / 2, ix) + oy % 2 * run, run, y.pixel(oy, 2 * ix));
  });
}

}  // namespace duo::simd
