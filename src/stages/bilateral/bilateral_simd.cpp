#include <algorithm>

#include "core/check.h"
#include "stages/bilateral/bilateral.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "stages/bilateral/bilateral_simd.cpp"
#include <hwy/foreach_target.h>
// After foreach_target.h, as Highway asks.
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace duo::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// Columns begin .. end of a row; `rows` are those above, of and below it, and all have a column to spare on both sides. The
/// last vector overlaps the one before it. Returns whether there was room for a vector.
bool bilateral_columns(const std::uint8_t* const* rows, int range, int begin, int end, std::uint8_t* dst) {
  const hn::ScalableTag<std::int32_t> d32;
  const hn::Rebind<float, decltype(d32)> df;
  const hn::Repartition<std::int16_t, decltype(d32)> d16;
  const hn::Rebind<std::uint8_t, decltype(d16)> d8;
  const int n = static_cast<int>(hn::Lanes(d16));
  if (end - begin < n) return false;
  const auto most = hn::Set(d16, static_cast<std::int16_t>(range + 1));
  const auto mean = [&](auto differences, auto weights) HWY_ATTR {
    const auto twice = hn::Add(hn::Add(differences, differences), weights);
    return hn::ConvertTo(d32, hn::Floor(hn::Div(hn::ConvertTo(df, twice), hn::ConvertTo(df, hn::Add(weights, weights)))));
  };
  for (int x = begin;; x = std::min(x + n, end - n)) {
    const auto v = hn::PromoteTo(d16, hn::LoadU(d8, rows[1] + x));
    auto differences = hn::Zero(d16), weights = most;
    for (int k = 0; k < 9; ++k) {
      if (k == 4) continue;
      const auto d = hn::Sub(hn::PromoteTo(d16, hn::LoadU(d8, rows[k / 3] + x + k % 3 - 1)), v);
      const auto weight = hn::Max(hn::Sub(most, hn::Abs(d)), hn::Zero(d16));
      differences = hn::Add(differences, hn::Mul(weight, d));
      weights = hn::Add(weights, weight);
    }
    const hn::Half<decltype(d16)> half;
    const auto low =
        mean(hn::PromoteTo(d32, hn::LowerHalf(half, differences)), hn::PromoteTo(d32, hn::LowerHalf(half, weights)));
    const auto high =
        mean(hn::PromoteTo(d32, hn::UpperHalf(half, differences)), hn::PromoteTo(d32, hn::UpperHalf(half, weights)));
    const auto moved = hn::Combine(d16, hn::DemoteTo(half, high), hn::DemoteTo(half, low));
    hn::StoreU(hn::DemoteTo(d8, hn::Add(v, moved)), d8, dst + x);
    if (x == end - n) return true;
  }
}

}  // namespace duo::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace duo {
HWY_EXPORT(bilateral_columns);

namespace simd {

void bilateral(Pool& pool, View<const std::uint8_t> src, int range, View<std::uint8_t> dst) {
  DUO_CHECK(src.size() == dst.size() && range >= 0 && range <= kMostBilateralRange);
  const int w = src.width(), h = src.height();
  pool.rows(h, [&](int begin, int end) {
    for (int y = begin; y < end; ++y) {
      const std::uint8_t* rows[3] = {src.row(std::max(y - 1, 0)), src.row(y), src.row(std::min(y + 1, h - 1))};
      const bool inner = HWY_DYNAMIC_DISPATCH(bilateral_columns)(rows, range, 1, w - 1, dst.row(y));
      for (int x = 0; x < w; x += inner ? std::max(w - 1, 1) : 1) dst.at(y, x) = bilateral_at(src, range, y, x);
    }
  });
}

}  // namespace simd
}  // namespace duo
#endif
