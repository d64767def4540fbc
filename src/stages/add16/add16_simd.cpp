#include <algorithm>

#include "core/check.h"
#include "core/tensor_parts.h"
#include "stages/add16/add16.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "stages/add16/add16_simd.cpp"
#include <hwy/foreach_target.h>
// After foreach_target.h, as Highway asks.
#include <hwy/highway.h>

#include "core/products-inl.h"

DUO_BEFORE_PRODUCTS();
namespace duo::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// A product of pairs is a * 2^left_a + b * 2^left_b, the factors being below 2^15.
void add_values(const Add16& layer, const std::int16_t* a, const std::int16_t* b, std::int16_t* y, int count) {
  const auto factors = (1 << layer.left_a) | 1 << (layer.left_b + 16);
  const std::int32_t half = (1 << layer.shift) / 2;
  const auto vector = [&](auto d, int i) HWY_ATTR {
    const hn::Repartition<std::int32_t, decltype(d)> d32;
    const auto from_a = hn::LoadU(d, a + i), from_b = b ? hn::LoadU(d, b + i) : hn::Zero(d);
    const auto scaled = [&](auto pairs) HWY_ATTR {
      Products<decltype(d32)> sum;
      sum.add(hn::BitCast(d32, pairs), hn::Set(d32, factors));
      return hn::ShiftRightSame(hn::Add(sum.sum(), hn::Set(d32, half)), layer.shift);
    };
    // Undoes the interleaving and saturates, which the range makes good.
    const auto values =
        hn::ReorderDemote2To(d, scaled(hn::InterleaveLower(d, from_a, from_b)), scaled(hn::InterleaveUpper(d, from_a, from_b)));
    hn::StoreU(hn::Clamp(values, hn::Set(d, layer.range.low), hn::Set(d, layer.range.high)), d, y + i);
  };
  const auto plain = [&](int i) {
    const std::int32_t from_b = b ? b[i] * (1 << layer.left_b) : 0;
    y[i] = layer.range.clamp((a[i] * (1 << layer.left_a) + from_b + half) >> layer.shift);
  };
  each_vector(hn::ScalableTag<std::int16_t>(), count, vector, plain);
}

void add_pixels(const Add16& layer, ConstTensor16 a, ConstTensor16 b, Tensor16 y, int begin, int end, int c_begin, int c_end) {
  const int channels = y.channels(), of_b = b.channels();
  if (of_b == channels && c_end - c_begin == channels)
    return add_values(layer, a.pixel(begin), b.pixel(begin), y.pixel(begin), (end - begin) * channels);
  const int c_both = std::clamp(of_b, c_begin, c_end);
  for (int p = begin; p < end; ++p) {
    add_values(layer, a.pixel(p) + c_begin, b.pixel(p) + c_begin, y.pixel(p) + c_begin, c_both - c_begin);
    add_values(layer, a.pixel(p) + c_both, nullptr, y.pixel(p) + c_both, c_end - c_both);
  }
}

}  // namespace duo::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace duo {
HWY_EXPORT(add_pixels);

namespace simd {

void add16(Pool& pool, const Add16& layer, ConstTensor16 a, ConstTensor16 b, Tensor16 y) {
  DUO_CHECK(a.size() == y.size() && b.size() == y.size());
  DUO_CHECK(a.channels() == y.channels() && b.channels() <= y.channels());
  const auto pixels = HWY_DYNAMIC_DISPATCH(add_pixels);
  each_tensor_part(pool, y, [&](int begin, int end, int c_begin, int c_end) {
    pixels(layer, a, b, y, begin * y.width(), end * y.width(), c_begin, c_end);
  });
}

}  // namespace simd
}  // namespace duo
#endif
