#include <algorithm>

#include "core/check.h"
#include "stages/median/median.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "stages/median/median_simd.cpp"
#include <hwy/foreach_target.h>
// After foreach_target.h, as Highway asks.
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace duo::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

template <class V>
HWY_INLINE V middle(V a, V b, V c) {
  return hn::Max(hn::Min(a, b), hn::Min(hn::Max(a, b), c));
}

// Lanes are x. Columns are sorted once each; the vectors for x-1 and x+1 are unaligned loads, sorted again, which costs
// less than carrying sorted columns from vector to vector.
template <class T>
void median_rows(View<const T> src, View<T> dst, int y_begin, int y_end) {
  const hn::ScalableTag<T> d;
  const int n = static_cast<int>(hn::Lanes(d));
  const int w = src.width(), h = src.height();
  for (int y = y_begin; y < y_end; ++y) {
    const T* up = src.row(std::max(y - 1, 0));
    const T* mid = src.row(y);
    const T* down = src.row(std::min(y + 1, h - 1));
    T* out = dst.row(y);

    const auto plain = [&](int x) {
      T low[3], middle_[3], high[3];
      for (int i = 0; i < 3; ++i) {
        const int xx = std::clamp(x + i - 1, 0, w - 1);
        const T lo = std::min(up[xx], mid[xx]), hi = std::max(up[xx], mid[xx]);
        low[i] = std::min(lo, down[xx]);
        middle_[i] = std::max(lo, std::min(hi, down[xx]));
        high[i] = std::max(hi, down[xx]);
      }
      const auto median3 = [](T a, T b, T c) { return std::max(std::min(a, b), std::min(std::max(a, b), c)); };
      out[x] = median3(std::max({low[0], low[1], low[2]}), median3(middle_[0], middle_[1], middle_[2]),
                       std::min({high[0], high[1], high[2]}));
    };
    const auto vector = [&](int x) {
      decltype(hn::Zero(d)) low[3], mids[3], high[3];
      for (int i = 0; i < 3; ++i) {
        const auto a = hn::LoadU(d, up + x + i - 1);
        const auto b = hn::LoadU(d, mid + x + i - 1);
        const auto c = hn::LoadU(d, down + x + i - 1);
        const auto lo = hn::Min(a, b), hi = hn::Max(a, b);
        low[i] = hn::Min(lo, c);
        mids[i] = hn::Max(lo, hn::Min(hi, c));
        high[i] = hn::Max(hi, c);
      }
      hn::StoreU(middle(hn::Max(hn::Max(low[0], low[1]), low[2]), middle(mids[0], mids[1], mids[2]),
                        hn::Min(hn::Min(high[0], high[1]), high[2])),
                 d, out + x);
    };

    plain(0);
    if (w < n + 2) {
      for (int x = 1; x < w; ++x) plain(x);
      continue;
    }
    for (int x = 1; x + n < w - 1; x += n) vector(x);
    vector(w - 1 - n);  // overlaps the one before: same values
    plain(w - 1);
  }
}

void median_rows_u8(View<const std::uint8_t> src, View<std::uint8_t> dst, int y_begin, int y_end) {
  median_rows(src, dst, y_begin, y_end);
}
void median_rows_u16(View<const std::uint16_t> src, View<std::uint16_t> dst, int y_begin, int y_end) {
  median_rows(src, dst, y_begin, y_end);
}

}  // namespace duo::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace duo {
HWY_EXPORT(median_rows_u8);
HWY_EXPORT(median_rows_u16);

namespace simd {

void median3x3(Pool& pool, View<const std::uint8_t> src, View<std::uint8_t> dst) {
  DUO_CHECK(src.size() == dst.size());
  const auto rows = HWY_DYNAMIC_DISPATCH(median_rows_u8);
  pool.rows(src.height(), [&](int begin, int end) { rows(src, dst, begin, end); });
}

void median3x3(Pool& pool, View<const std::uint16_t> src, View<std::uint16_t> dst) {
  DUO_CHECK(src.size() == dst.size());
  const auto rows = HWY_DYNAMIC_DISPATCH(median_rows_u16);
  pool.rows(src.height(), [&](int begin, int end) { rows(src, dst, begin, end); });
}

}  // namespace simd
}  // namespace duo
#endif
