#include <algorithm>

#include "core/check.h"
#include "core/tensor_parts.h"
#include "stages/maxpool2x16/maxpool2x16.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "stages/maxpool2x16/maxpool2x16_simd.cpp"
#include <hwy/foreach_target.h>
// After foreach_target.h, as Highway asks.
#include <hwy/highway.h>

#include "core/products-inl.h"

DUO_BEFORE_PRODUCTS();
namespace duo::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

void maxpool_rows(ConstTensor16 x, Tensor16 y, int oy_begin, int oy_end) {
  for (int oy = oy_begin; oy < oy_end; ++oy)
    for (int ox = 0; ox < y.width(); ++ox) {
      const std::int16_t* up = x.pixel(2 * oy, 2 * ox);
      const std::int16_t* down = x.pixel(2 * oy + 1, 2 * ox);
      std::int16_t* out = y.pixel(oy, ox);
      const int beside = x.channels();
      const auto vector = [&](auto d, int c) HWY_ATTR {
        hn::StoreU(hn::Max(hn::Max(hn::LoadU(d, up + c), hn::LoadU(d, up + c + beside)),
                           hn::Max(hn::LoadU(d, down + c), hn::LoadU(d, down + c + beside))),
                   d, out + c);
      };
      const auto plain = [&](int c) { out[c] = std::max({up[c], up[c + beside], down[c], down[c + beside]}); };
      each_vector(hn::ScalableTag<std::int16_t>(), beside, vector, plain);
    }
}

}  // namespace duo::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace duo {
HWY_EXPORT(maxpool_rows);

namespace simd {

void maxpool2x16(Pool& pool, ConstTensor16 x, Tensor16 y) {
  DUO_CHECK(x.width() == 2 * y.width() && x.height() == 2 * y.height() && x.channels() == y.channels());
  const auto rows = HWY_DYNAMIC_DISPATCH(maxpool_rows);
  each_tensor_row(pool, y, [&](int begin, int end) { rows(x, y, begin, end); });
}

}  // namespace simd
}  // namespace duo
#endif
