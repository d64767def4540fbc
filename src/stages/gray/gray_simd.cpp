#include "core/check.h"
#include "stages/gray/gray.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "stages/gray/gray_simd.cpp"
#include <hwy/foreach_target.h>
// After foreach_target.h, as Highway asks.
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace duo::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

void gray_rows(View<const Rgb8> src, View<std::uint8_t> dst, int y_begin, int y_end) {
  const hn::ScalableTag<std::uint16_t> d16;
  const hn::Rebind<std::uint8_t, decltype(d16)> d8;
  const int n = static_cast<int>(hn::Lanes(d16)), w = dst.width();
  const auto r_weight = hn::Set(d16, 77), g_weight = hn::Set(d16, 150), b_weight = hn::Set(d16, 29), half = hn::Set(d16, 128);
  for (int y = y_begin; y < y_end; ++y) {
    const Rgb8* in = src.row(y);
    std::uint8_t* out = dst.row(y);
    if (w < n) {
      for (int x = 0; x < w; ++x)
        out[x] = static_cast<std::uint8_t>((77 * in[x].r + 150 * in[x].g + 29 * in[x].b + 128) >> 8);
      continue;
    }
    const auto vector = [&](int x) {
      hn::Vec<decltype(d8)> r, g, b;
      hn::LoadInterleaved3(d8, &in[x].r, r, g, b);
      // 255 * 256 + 128 fits 16 bits.
      auto sum = hn::Add(half, hn::Mul(hn::PromoteTo(d16, r), r_weight));
      sum = hn::Add(sum, hn::Mul(hn::PromoteTo(d16, g), g_weight));
      sum = hn::Add(sum, hn::Mul(hn::PromoteTo(d16, b), b_weight));
      hn::StoreU(hn::TruncateTo(d8, hn::ShiftRight<8>(sum)), d8, out + x);
    };
    for (int x = 0; x + n < w; x += n) vector(x);
    vector(w - n);  // overlaps the one before: same values
  }
}

}  // namespace duo::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace duo {
HWY_EXPORT(gray_rows);

namespace simd {

void gray(Pool& pool, View<const Rgb8> src, View<std::uint8_t> dst) {
  DUO_CHECK(src.size() == dst.size());
  const auto rows = HWY_DYNAMIC_DISPATCH(gray_rows);
  pool.rows(src.height(), [&](int begin, int end) { rows(src, dst, begin, end); });
}

}  // namespace simd
}  // namespace duo
#endif
