// Lanes are samples of chroma; each gives the colours of two pixels, the even and the odd one.

#include <algorithm>

#include "core/check.h"
#include "stages/yuv_rgb/yuv_rgb.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "stages/yuv_rgb/yuv_rgb_simd.cpp"
#include <hwy/foreach_target.h>
// After foreach_target.h, as Highway asks.
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace duo::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using ColorTag = hn::CappedTag<std::int16_t, 32>;
using ColorUnsignedTag = hn::RebindToUnsigned<ColorTag>;
using ColorVec = hn::Vec<ColorTag>;
constexpr int kBeside = 1;  // samples before a row's first and after its last

/// The sums of two rows, less 256; at the ends once more.
void sum_of_rows(View<const std::uint8_t> plane, ChromaRows rows, std::int16_t* out) {
  const std::uint8_t *first = plane.row(rows.first), *second = plane.row(rows.second);
  const int n = plane.width();
  for (int x = 0; x < n; ++x) out[kBeside + x] = static_cast<std::int16_t>(first[x] + second[x] - 256);
  out[0] = out[kBeside];
  out[kBeside + n] = out[n];
}

/// (a b + 32768) >> 16, which fits 16 bits.
HWY_INLINE ColorVec rounded_product(ColorVec a, ColorVec b) {
  const ColorTag d;
  const ColorUnsignedTag du;
  return hn::Add(hn::MulHigh(a, b), hn::BitCast(d, hn::ShiftRight<15>(hn::BitCast(du, hn::Mul(a, b)))));
}

/// (a b + c e + 32768) >> 16: the low halves' sum may carry, and its rounding too.
HWY_INLINE ColorVec rounded_products(ColorVec a, ColorVec b, ColorVec c, ColorVec e) {
  const ColorTag d;
  const ColorUnsignedTag du;
  const auto low = hn::BitCast(du, hn::Mul(a, b)), sum = hn::Add(low, hn::BitCast(du, hn::Mul(c, e)));
  const auto carry = hn::IfThenElseZero(hn::Lt(sum, low), hn::Set(du, 1));
  const auto more = hn::Add(carry, hn::ShiftRight<15>(sum));
  return hn::Add(hn::Add(hn::MulHigh(a, b), hn::MulHigh(c, e)), hn::BitCast(d, more));
}

struct Colors {
  ColorVec r, g, b;
};

class Row {
 public:
  Row(const YuvWeights& weights, const std::int16_t* u, const std::int16_t* v, const std::uint8_t* luma, Rgb8* out)
      : weights_(weights), u_(u), v_(v), luma_(luma), out_(out) {}

  /// The pixels of the samples from i on.
  HWY_INLINE void pixels(int i) const {
    const ColorTag d;
    const ColorUnsignedTag du;
    const hn::Repartition<std::uint8_t, ColorTag> d8;
    const auto luma = hn::BitCast(du, hn::LoadU(d8, luma_ + 2 * i));
    const auto even = hn::BitCast(d, hn::And(luma, hn::Set(du, 0xFF))), odd = hn::BitCast(d, hn::ShiftRight<8>(luma));
    const Colors left = colors(even, i, i - 1), right = colors(odd, i, i + 1);
    const auto both = [&](ColorVec a, ColorVec b) HWY_ATTR { return hn::BitCast(d8, hn::Or(a, hn::ShiftLeft<8>(b))); };
    hn::StoreInterleaved3(both(left.r, right.r), both(left.g, right.g), both(left.b, right.b), d8, &out_[2 * i].r);
  }

 private:
  HWY_INLINE Colors colors(ColorVec luma, int near, int far) const {
    const ColorTag d;
    const auto chroma = [&](const std::int16_t* sums) HWY_ATTR {
      const ColorVec here = hn::LoadU(d, sums + kBeside + near), beside = hn::LoadU(d, sums + kBeside + far);
      return hn::Add(hn::Add(here, hn::Add(here, here)), beside);
    };
    const auto clipped = [&](ColorVec added)
                             HWY_ATTR { return hn::Min(hn::Max(hn::Add(luma, added), hn::Zero(d)), hn::Set(d, 255)); };
    const ColorVec u = chroma(u_), v = chroma(v_);
    return {clipped(rounded_product(v, hn::Set(d, weights_.red_of_v))),
            clipped(rounded_products(u, hn::Set(d, weights_.green_of_u), v, hn::Set(d, weights_.green_of_v))),
            clipped(rounded_product(u, hn::Set(d, weights_.blue_of_u)))};
  }

  const YuvWeights& weights_;
  const std::int16_t *u_, *v_;
  const std::uint8_t* luma_;
  Rgb8* out_;
};

void yuv_rgb_rows(const YuvPlanes& src, const YuvWeights& weights, simd::YuvScratch& scratch, View<Rgb8> dst) {
  const ColorTag d;
  const int n = static_cast<int>(hn::Lanes(d)), samples = src.u.width();
  std::int16_t *const u = scratch.u.row(0), *const v = scratch.v.row(0);
  Rgb8 some[2 * hn::MaxLanes(d)];
  std::uint8_t some_luma[2 * hn::MaxLanes(d)] = {};
  for (int y = 0; y < dst.height(); ++y) {
    const ChromaRows rows = chroma_rows(src, y);
    sum_of_rows(src.u, rows, u);
    sum_of_rows(src.v, rows, v);
    const Row row(weights, u, v, src.y.row(y), dst.row(y));
    if (samples >= n) {
      for (int i = 0; i + n < samples; i += n) row.pixels(i);
      row.pixels(samples - n);  // overlaps the one before: same values
      continue;
    }
    std::copy_n(src.y.row(y), dst.width(), some_luma);
    Row(weights, u, v, some_luma, some).pixels(0);
    std::copy_n(some, dst.width(), dst.row(y));
  }
}

}  // namespace duo::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace duo {
HWY_EXPORT(yuv_rgb_rows);

namespace simd {

// A vector that begins at the last sample may be read.
YuvScratch::YuvScratch(int width_in) : width(width_in), u({width / 2 + 64, 1}), v({width / 2 + 64, 1}) {}

void yuv_rgb(const YuvPlanes& src, const YuvWeights& weights, YuvScratch& scratch, View<Rgb8> dst) {
  DUO_CHECK(src.well_shaped() && src.y.size() == dst.size());
  DUO_CHECK(scratch.width == dst.width());
  HWY_DYNAMIC_DISPATCH(yuv_rgb_rows)(src, weights, scratch, dst);
}

}  // namespace simd
}  // namespace duo
#endif
