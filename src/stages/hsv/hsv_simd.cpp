#include "core/check.h"
#include "stages/hsv/hsv.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "stages/hsv/hsv_simd.cpp"
#include <hwy/foreach_target.h>
// After foreach_target.h, as Highway asks.
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace duo::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// Lanes are x: 16 bits for the differences (at most 6 * 255), 32 bits for the quotients.
void hsv_rows(View<const Rgb8> src, const HsvPlanes& dst, int y_begin, int y_end) {
  const hn::ScalableTag<std::int16_t> d16;
  const hn::RebindToUnsigned<decltype(d16)> du16;
  const hn::Rebind<std::uint8_t, decltype(d16)> d8;
  const hn::Half<decltype(d16)> d16_half;
  const hn::Half<decltype(d8)> d8_half;
  const hn::RepartitionToWide<decltype(d16)> d32;
  const hn::Rebind<float, decltype(d32)> df;
  const int n = static_cast<int>(hn::Lanes(d16)), half = n / 2, w = src.width();

  const auto quotient = [&](auto a, auto b) {
    const auto nearest = hn::Div(hn::ConvertTo(df, a), hn::ConvertTo(df, hn::Max(b, hn::Set(d32, 1))));
    return hn::ConvertTo(d32, nearest);
  };
  const auto divide = [&](auto sixths, auto chroma, auto largest, std::uint8_t* hue, std::uint8_t* saturation) {
    const auto n32 = hn::PromoteTo(d32, sixths), c32 = hn::PromoteTo(d32, chroma), m32 = hn::PromoteTo(d32, largest);
    const auto c3 = hn::Add(c32, hn::Add(c32, c32));
    const auto turn = quotient(hn::Add(hn::ShiftLeft<8>(n32), c3), hn::Add(c3, c3));
    const auto share = quotient(hn::Add(hn::Sub(hn::ShiftLeft<9>(c32), hn::Add(c32, c32)), m32), hn::Add(m32, m32));
    hn::StoreU(hn::DemoteTo(d8_half, hn::And(turn, hn::Set(d32, 255))), d8_half, hue);
    hn::StoreU(hn::DemoteTo(d8_half, share), d8_half, saturation);
  };

  for (int y = y_begin; y < y_end; ++y) {
    const Rgb8* in = src.row(y);
    std::uint8_t *hue = dst.hue.row(y), *saturation = dst.saturation.row(y), *value = dst.value.row(y);
    const auto vector = [&](int x) {
      hn::Vec<decltype(d8)> r8, g8, b8;
      hn::LoadInterleaved3(d8, &in[x].r, r8, g8, b8);
      const auto r = hn::PromoteTo(d16, r8), g = hn::PromoteTo(d16, g8), b = hn::PromoteTo(d16, b8);
      const auto largest = hn::Max(hn::Max(r, g), b);
      const auto chroma = hn::Sub(largest, hn::Min(hn::Min(r, g), b));
      const auto twice = hn::Add(chroma, chroma), four = hn::Add(twice, twice);
      const auto from_red = hn::Sub(g, b);
      const auto red = hn::Add(from_red, hn::IfThenElseZero(hn::Lt(from_red, hn::Zero(d16)), hn::Add(twice, four)));
      const auto green = hn::Add(hn::Sub(b, r), twice), blue = hn::Add(hn::Sub(r, g), four);
      const auto sixths = hn::IfThenElse(hn::Eq(r, largest), red, hn::IfThenElse(hn::Eq(g, largest), green, blue));
      divide(hn::LowerHalf(d16_half, sixths), hn::LowerHalf(d16_half, chroma), hn::LowerHalf(d16_half, largest), hue + x,
             saturation + x);
      divide(hn::UpperHalf(d16_half, sixths), hn::UpperHalf(d16_half, chroma), hn::UpperHalf(d16_half, largest), hue + x + half,
             saturation + x + half);
      hn::StoreU(hn::TruncateTo(d8, hn::BitCast(du16, largest)), d8, value + x);
    };
    if (w < n) {
      const Size row{w, 1};
      ref::hsv(src.crop(y, 0, row), {dst.hue.crop(y, 0, row), dst.saturation.crop(y, 0, row), dst.value.crop(y, 0, row)});
      continue;
    }
    for (int x = 0; x + n < w; x += n) vector(x);
    vector(w - n);  // overlaps the one before: same values
  }
}

}  // namespace duo::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace duo {
HWY_EXPORT(hsv_rows);

namespace simd {

void hsv(Pool& pool, View<const Rgb8> src, const HsvPlanes& dst) {
  DUO_CHECK(src.size() == dst.hue.size() && src.size() == dst.saturation.size() && src.size() == dst.value.size());
  const auto rows = HWY_DYNAMIC_DISPATCH(hsv_rows);
  pool.rows(src.height(), [&](int begin, int end) { rows(src, dst, begin, end); });
}

}  // namespace simd
}  // namespace duo
#endif
