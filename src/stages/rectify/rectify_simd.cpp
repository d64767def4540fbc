#include <algorithm>

#include "core/check.h"
#include "stages/rectify/rectify.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "stages/rectify/rectify_simd.cpp"
#include <hwy/foreach_target.h>
// After foreach_target.h, as Highway asks.
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace duo::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// Lanes are x. One 32-bit gather fetches p00 and p01, another p10 and p11 (two bytes of each are not used). The lower one
// could pass the end of the last row, by two bytes at most: there it starts that much earlier and is shifted back.
void rectify_rows(View<const std::uint8_t> src, const ResampleMap& map, View<std::uint8_t> dst, View<std::uint8_t> inside,
                  int y_begin, int y_end) {
  const hn::ScalableTag<std::uint32_t> d;
  const hn::Repartition<std::uint16_t, decltype(d)> d_pairs;
  const hn::RebindToSigned<decltype(d)> d_signed;
  const hn::Rebind<std::uint16_t, decltype(d)> d_u16;
  const hn::Rebind<std::uint8_t, decltype(d)> d_u8;
  const int n = static_cast<int>(hn::Lanes(d));
  const int w = dst.width(), stride = static_cast<int>(src.stride());
  const std::int32_t last_word = (src.height() - 1) * stride + src.width() - 4;
  const auto* words = reinterpret_cast<const std::uint32_t*>(src.data());

  // p0 (256 - fx) + p1 fx <= 65280 fits 16 bits, so the two products of a pixel are the two halves of its lane.
  const auto across = [&](auto word, auto weights) {
    const auto pair = hn::Or(hn::And(word, hn::Set(d, 0xFF)), hn::ShiftLeft<8>(hn::And(word, hn::Set(d, 0xFF00))));
    const auto products = hn::BitCast(d, hn::Mul(hn::BitCast(d_pairs, pair), hn::BitCast(d_pairs, weights)));
    return hn::Add(hn::And(products, hn::Set(d, 0xFFFF)), hn::ShiftRight<16>(products));
  };
  const auto vector = [&](const std::uint32_t* corner_row, const std::uint16_t* fraction_row, std::uint8_t* out,
                          std::uint8_t* inside_out) {
    const auto corner = hn::LoadU(d, corner_row);
    const auto seen = hn::VecFromMask(d, hn::Ne(corner, hn::Set(d, ResampleMap::kOutside)));
    const auto place = hn::And(corner, seen);
    const auto x0 = hn::ShiftRight<16>(place), y0 = hn::And(place, hn::Set(d, 0xFFFF));
    const auto upper_at = hn::BitCast(d_signed, hn::Add(hn::Mul(y0, hn::Set(d, static_cast<std::uint32_t>(stride))), x0));
    const auto lower_at = hn::Add(upper_at, hn::Set(d_signed, stride));
    const auto lower_from = hn::Min(lower_at, hn::Set(d_signed, last_word));
    const auto back = hn::BitCast(d, hn::ShiftLeft<3>(hn::Sub(lower_at, lower_from)));

    const auto fraction = hn::PromoteTo(d, hn::LoadU(d_u16, fraction_row));
    const auto fx = hn::ShiftRight<8>(fraction), fy = hn::And(fraction, hn::Set(d, 0xFF));
    const auto weights = hn::Or(hn::Sub(hn::Set(d, 256), fx), hn::ShiftLeft<16>(fx));
    const auto top = across(hn::GatherOffset(d, words, upper_at), weights);
    const auto bottom = across(hn::Shr(hn::GatherOffset(d, words, lower_from), back), weights);

    // top 256 + (bottom - top) fy: the true result is not negative, so wrapping in between does no harm.
    const auto sum = hn::Add(hn::ShiftLeft<8>(top), hn::Mul(hn::Sub(bottom, top), fy));
    const auto value = hn::And(hn::ShiftRight<16>(hn::Add(sum, hn::Set(d, 32768))), seen);
    hn::StoreU(hn::DemoteTo(d_u8, hn::BitCast(d_signed, value)), d_u8, out);
    hn::StoreU(hn::DemoteTo(d_u8, hn::BitCast(d_signed, hn::And(seen, hn::Set(d, 255)))), d_u8, inside_out);
  };

  for (int y = y_begin; y < y_end; ++y) {
    const std::uint32_t* corner = map.corner.row(y);
    const std::uint16_t* fraction = map.fraction_q8.row(y);
    if (w >= n) {
      for (int x = 0; x + n < w; x += n) vector(corner + x, fraction + x, dst.row(y) + x, inside.row(y) + x);
      vector(corner + w - n, fraction + w - n, dst.row(y) + w - n, inside.row(y) + w - n);
      continue;
    }
    HWY_ALIGN std::uint32_t some_corners[hn::MaxLanes(d)];
    HWY_ALIGN std::uint16_t some_fractions[hn::MaxLanes(d)] = {};
    HWY_ALIGN std::uint8_t values[hn::MaxLanes(d)], flags[hn::MaxLanes(d)];
    std::fill_n(some_corners, n, ResampleMap::kOutside);
    std::copy_n(corner, w, some_corners);
    std::copy_n(fraction, w, some_fractions);
    vector(some_corners, some_fractions, values, flags);
    std::copy_n(values, w, dst.row(y));
    std::copy_n(flags, w, inside.row(y));
  }
}

}  // namespace duo::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace duo {
HWY_EXPORT(rectify_rows);

namespace simd {

void rectify(Pool& pool, View<const std::uint8_t> src, const ResampleMap& map, View<std::uint8_t> dst,
             View<std::uint8_t> inside) {
  DUO_CHECK(dst.size() == map.corner.size() && inside.size() == dst.size());
  DUO_CHECK(src.width() >= 2 && src.height() >= 2 && src.stride() * src.height() < (std::int64_t{1} << 31));
  const auto rows = HWY_DYNAMIC_DISPATCH(rectify_rows);
  pool.rows(dst.height(), [&](int begin, int end) { rows(src, map, dst, inside, begin, end); });
}

void rectify(Pool& pool, View<const Rgb8> src, const ResampleMap& map, View<Rgb8> dst) {
  DUO_CHECK(dst.size() == map.corner.size());
  pool.rows(dst.height(), [&](int begin, int end) {
    for (int y = begin; y < end; ++y)
      for (int x = 0; x < dst.width(); ++x) {
        const std::uint32_t corner = map.corner.at(y, x);
        if (corner == ResampleMap::kOutside) {
          dst.at(y, x) = {};
          continue;
        }
        const std::uint32_t fx = map.fraction_q8.at(y, x) >> 8, fy = map.fraction_q8.at(y, x) & 0xFF;
        const Rgb8* top = src.row(static_cast<int>(corner & 0xFFFF)) + (corner >> 16);
        const Rgb8* bottom = top + src.stride();
        const auto blend = [&](std::uint8_t Rgb8::*channel) {
          const std::uint32_t upper = top[0].*channel * (256 - fx) + top[1].*channel * fx;
          const std::uint32_t lower = bottom[0].*channel * (256 - fx) + bottom[1].*channel * fx;
          return static_cast<std::uint8_t>((upper * (256 - fy) + lower * fy + 32768) >> 16);
        };
        dst.at(y, x) = {blend(&Rgb8::r), blend(&Rgb8::g), blend(&Rgb8::b)};
      }
  });
}

}  // namespace simd
}  // namespace duo
#endif
