#include <algorithm>

#include "core/check.h"
#include "core/tensor_parts.h"
#include "stages/sum_pixels16/sum_pixels16.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "stages/sum_pixels16/sum_pixels16_simd.cpp"
#include <hwy/foreach_target.h>
// After foreach_target.h, as Highway asks.
#include <hwy/highway.h>

#include "core/products-inl.h"

DUO_BEFORE_PRODUCTS();
namespace duo::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// Lanes are channels; two pixels at once, as pairs whose weights are 1.
void sum_channels(ConstTensor16 x, int shift, Tensor16 y, int c_begin, int c_end) {
  const int pixels = x.pixels();
  const std::int32_t half = (1 << shift) / 2;
  const auto vector = [&](auto d, int i) HWY_ATTR {
    const int c = c_begin + i;
    const hn::Repartition<std::int32_t, decltype(d)> d32;
    const auto ones = hn::Set(d32, 1 | 1 << 16);
    Products<decltype(d32)> lower, upper;
    for (int p = 0; p < pixels; p += 2) {
      const auto even = hn::LoadU(d, x.pixel(p) + c), odd = p + 1 < pixels ? hn::LoadU(d, x.pixel(p + 1) + c) : hn::Zero(d);
      lower.add(hn::BitCast(d32, hn::InterleaveLower(d, even, odd)), ones);
      upper.add(hn::BitCast(d32, hn::InterleaveUpper(d, even, odd)), ones);
    }
    const auto rounded = [&](auto sum) HWY_ATTR { return hn::ShiftRightSame(hn::Add(sum, hn::Set(d32, half)), shift); };
    // Undoes the interleaving.
    hn::StoreU(hn::ReorderDemote2To(d, rounded(lower.sum()), rounded(upper.sum())), d, y.data() + c);
  };
  const auto plain = [&](int i) {
    const int c = c_begin + i;
    std::int32_t sum = half;
    for (int p = 0; p < pixels; ++p) sum += x.pixel(p)[c];
    y.data()[c] = static_cast<std::int16_t>(sum >> shift);
  };
  each_vector(hn::ScalableTag<std::int16_t>(), c_end - c_begin, vector, plain);
}

}  // namespace duo::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace duo {
HWY_EXPORT(sum_channels);

namespace simd {

void sum_pixels16(Pool& pool, ConstTensor16 x, int shift, Tensor16 y) {
  DUO_CHECK(y.pixels() == 1 && x.channels() == y.channels() && shift <= 15 && x.pixels() <= 1 << shift);
  const auto sum = HWY_DYNAMIC_DISPATCH(sum_channels);
  each_tensor_part(pool, y, [&](int, int, int c_begin, int c_end) { sum(x, shift, y, c_begin, c_end); });
}

}  // namespace simd
}  // namespace duo
#endif
