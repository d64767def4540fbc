#include <algorithm>

#include "core/check.h"
#include "core/tensor_parts.h"
#include "stages/resize2x16/resize2x16.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "stages/resize2x16/resize2x16_simd.cpp"
#include <hwy/foreach_target.h>
// After foreach_target.h, as Highway asks.
#include <hwy/highway.h>

#include "core/products-inl.h"

DUO_BEFORE_PRODUCTS();
namespace duo::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

void resize_rows(ConstTensor16 x, Tensor16 y, int oy_begin, int oy_end) {
  for (int oy = oy_begin; oy < oy_end; ++oy) {
    const int near_y = oy / 2, far_y = std::clamp(oy % 2 ? near_y + 1 : near_y - 1, 0, x.height() - 1);
    for (int ox = 0; ox < y.width(); ++ox) {
      const int near_x = ox / 2, far_x = std::clamp(ox % 2 ? near_x + 1 : near_x - 1, 0, x.width() - 1);
      const std::int16_t* near_near = x.pixel(near_y, near_x);
      const std::int16_t* near_far = x.pixel(near_y, far_x);
      const std::int16_t* far_near = x.pixel(far_y, near_x);
      const std::int16_t* far_far = x.pixel(far_y, far_x);
      std::int16_t* out = y.pixel(oy, ox);
      const auto vector = [&](auto d, int c) HWY_ATTR {
        const hn::Repartition<std::int32_t, decltype(d)> d32;
        const auto a = hn::LoadU(d, near_near + c), b = hn::LoadU(d, near_far + c);
        const auto e = hn::LoadU(d, far_near + c), f = hn::LoadU(d, far_far + c);
        const auto weighted = [&](auto near_pairs, auto far_pairs) HWY_ATTR {
          Products<decltype(d32)> sum;
          sum.add(hn::BitCast(d32, near_pairs), hn::Set(d32, 9 | 3 << 16));
          sum.add(hn::BitCast(d32, far_pairs), hn::Set(d32, 3 | 1 << 16));
          return hn::ShiftRight<4>(hn::Add(sum.sum(), hn::Set(d32, 8)));
        };
        // Undoes the interleaving.
        hn::StoreU(hn::ReorderDemote2To(d, weighted(hn::InterleaveLower(d, a, b), hn::InterleaveLower(d, e, f)),
                                        weighted(hn::InterleaveUpper(d, a, b), hn::InterleaveUpper(d, e, f))),
                   d, out + c);
      };
      const auto plain = [&](int c) {
        out[c] = static_cast<std::int16_t>((9 * near_near[c] + 3 * near_far[c] + 3 * far_near[c] + far_far[c] + 8) >> 4);
      };
      each_vector(hn::ScalableTag<std::int16_t>(), y.channels(), vector, plain);
    }
  }
}

}  // namespace duo::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace duo {
HWY_EXPORT(resize_rows);

namespace simd {

void resize2x16(Pool& pool, ConstTensor16 x, Tensor16 y) {
  DUO_CHECK(y.width() == 2 * x.width() && y.height() == 2 * x.height() && x.channels() == y.channels());
  const auto rows = HWY_DYNAMIC_DISPATCH(resize_rows);
  each_tensor_row(pool, y, [&](int begin, int end) { rows(x, y, begin, end); });
}

}  // namespace simd
}  // namespace duo
#endif
