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

using PlaceTag = hn::ScalableTag<std::uint32_t>;
using PlaceVec = hn::Vec<PlaceTag>;

/// Where a vector of pixels lies in the raw picture. Lanes are x.
struct Place {
  PlaceVec seen, x0, y0, fx_weights, fy;

  Place(const std::uint32_t* corner_row, const std::uint16_t* fraction_row) {
    const PlaceTag d;
    const auto corner = hn::LoadU(d, corner_row);
    seen = hn::VecFromMask(d, hn::Ne(corner, hn::Set(d, ResampleMap::kOutside)));
    const auto place = hn::And(corner, seen);
    x0 = hn::ShiftRight<16>(place);
    y0 = hn::And(place, hn::Set(d, 0xFFFF));
    const auto fraction = hn::PromoteTo(d, hn::LoadU(hn::Rebind<std::uint16_t, PlaceTag>(), fraction_row));
    const auto fx = hn::ShiftRight<8>(fraction);
    fx_weights = hn::Or(hn::Sub(hn::Set(d, 256), fx), hn::ShiftLeft<16>(fx));
    fy = hn::And(fraction, hn::Set(d, 0xFF));
  }

  /// From the left and the right pixel, one in each half of a lane.
  PlaceVec across(PlaceVec pair) const {
    const PlaceTag d;
    const hn::Repartition<std::uint16_t, PlaceTag> d_pairs;
    // p0 (256 - fx) + p1 fx <= 65280 fits 16 bits.
    const auto products = hn::BitCast(d, hn::Mul(hn::BitCast(d_pairs, pair), hn::BitCast(d_pairs, fx_weights)));
    return hn::Add(hn::And(products, hn::Set(d, 0xFFFF)), hn::ShiftRight<16>(products));
  }

  using Signed = hn::Vec<hn::RebindToSigned<PlaceTag>>;
  struct Weights {
    Signed before, here, after, last;
  };
  /// cubic_weights() in lanes.
  Weights cubic() const {
    const hn::RebindToSigned<PlaceTag> d;
    const auto f = hn::BitCast(d, fy), f2 = hn::Mul(f, f), f3 = hn::Mul(f2, f), linear = hn::ShiftLeft<16>(f);
    const auto rounded = [&](auto v) HWY_ATTR { return hn::ShiftRight<17>(hn::Add(v, hn::Set(d, 1 << 16))); };
    const auto before = rounded(hn::Sub(hn::Sub(hn::ShiftLeft<9>(f2), f3), linear));
    const auto after = rounded(hn::Add(hn::Sub(hn::ShiftLeft<10>(f2), hn::Mul(f3, hn::Set(d, 3))), linear));
    const auto last = rounded(hn::Sub(f3, hn::ShiftLeft<8>(f2)));
    return {before, hn::Sub(hn::Set(d, 256), hn::Add(before, hn::Add(after, last))), after, last};
  }
  /// soft_weights() in lanes.
  Weights soft() const {
    const hn::RebindToSigned<PlaceTag> d;
    const auto f = hn::BitCast(d, fy), whole = hn::ShiftRight<2>(hn::Mul(f, hn::Sub(hn::Set(d, 256), f)));
    const auto beside = hn::ShiftRight<24>(hn::Add(hn::Mul(hn::Mul(whole, whole), hn::Set(d, 10)), hn::Set(d, 1 << 23)));
    return {beside, hn::Sub(hn::Set(d, 256), hn::Add(beside, beside)), beside, hn::Zero(d)};
  }

  /// From the pairs of four rows.
  hn::Vec<hn::Rebind<std::uint8_t, PlaceTag>> value(const Weights& weights, PlaceVec before_pair, PlaceVec here_pair,
                                                    PlaceVec after_pair, PlaceVec last_pair) const {
    const hn::RebindToSigned<PlaceTag> d;
    const auto row = [&](PlaceVec pair, Signed weight) HWY_ATTR { return hn::Mul(hn::BitCast(d, across(pair)), weight); };
    const auto sum = hn::Add(hn::Add(row(before_pair, weights.before), row(here_pair, weights.here)),
                             hn::Add(row(after_pair, weights.after), row(last_pair, weights.last)));
    const auto value = hn::And(hn::ShiftRight<16>(hn::Add(sum, hn::Set(d, 32768))), hn::BitCast(d, seen));
    return hn::DemoteTo(hn::Rebind<std::uint8_t, PlaceTag>(), value);  // clips
  }

  hn::Vec<hn::Rebind<std::uint8_t, PlaceTag>> value(PlaceVec top_pair, PlaceVec bottom_pair) const {
    const PlaceTag d;
    const auto top = across(top_pair), bottom = across(bottom_pair);
    // top 256 + (bottom - top) fy: the true result is not negative, so wrapping in between does no harm.
    const auto sum = hn::Add(hn::ShiftLeft<8>(top), hn::Mul(hn::Sub(bottom, top), fy));
    const auto rounded = hn::And(hn::ShiftRight<16>(hn::Add(sum, hn::Set(d, 32768))), seen);
    return hn::DemoteTo(hn::Rebind<std::uint8_t, PlaceTag>(), hn::BitCast(hn::RebindToSigned<PlaceTag>(), rounded));
  }
};

// One 32-bit gather fetches p00 and p01, another p10 and p11 (two bytes of each are not used). The last row could be passed at
// its end, by two bytes at most: there a gather starts that much earlier and is shifted back.
void rectify_rows(View<const std::uint8_t> src, const ResampleMap& map, View<std::uint8_t> dst, View<std::uint8_t> inside,
                  int y_begin, int y_end) {
  const PlaceTag d;
  const hn::RebindToSigned<PlaceTag> d_signed;
  const hn::Rebind<std::uint8_t, PlaceTag> d_u8;
  const int n = static_cast<int>(hn::Lanes(d));
  const int w = dst.width(), stride = static_cast<int>(src.stride());
  const std::int32_t last_word = (src.height() - 1) * stride + src.width() - 4;
  const auto* words = reinterpret_cast<const std::uint32_t*>(src.data());

  const auto pair = [&](auto word) {
    return hn::Or(hn::And(word, hn::Set(d, 0xFF)), hn::ShiftLeft<8>(hn::And(word, hn::Set(d, 0xFF00))));
  };
  const auto vector = [&](const std::uint32_t* corner_row, const std::uint16_t* fraction_row, std::uint8_t* out,
                          std::uint8_t* inside_out) {
    const Place p(corner_row, fraction_row);
    const auto upper_at = hn::BitCast(d_signed, hn::Add(hn::Mul(p.y0, hn::Set(d, static_cast<std::uint32_t>(stride))), p.x0));
    const auto lower_at = hn::Add(upper_at, hn::Set(d_signed, stride));
    const auto fetched = [&](auto at) HWY_ATTR {
      const auto from = hn::Min(at, hn::Set(d_signed, last_word));
      return pair(hn::Shr(hn::GatherOffset(d, words, from), hn::BitCast(d, hn::ShiftLeft<3>(hn::Sub(at, from)))));
    };
    if (map.columns == ResampleMap::Columns::kLinear) {
      hn::StoreU(p.value(pair(hn::GatherOffset(d, words, upper_at)), fetched(lower_at)), d_u8, out);
    } else {
      const auto x0 = hn::BitCast(d_signed, p.x0), step = hn::Set(d_signed, stride);
      const auto end = hn::Add(x0, hn::Set(d_signed, (src.height() - 1) * stride));  // the first and the last row continue
      const auto weights = map.columns == ResampleMap::Columns::kCubic ? p.cubic() : p.soft();
      hn::StoreU(p.value(weights, fetched(hn::Max(hn::Sub(upper_at, step), x0)), fetched(upper_at),
                         fetched(hn::Min(lower_at, end)), fetched(hn::Min(hn::Add(lower_at, step), end))),
                 d_u8, out);
    }
    hn::StoreU(hn::DemoteTo(d_u8, hn::BitCast(d_signed, hn::And(p.seen, hn::Set(d, 255)))), d_u8, inside_out);
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

// Two pixels are six bytes: one gather fetches the first four, r g b r, and another the last, b r g b.
void rectify_color_rows(View<const Rgb8> src, const ResampleMap& map, View<Rgb8> dst, int y_begin, int y_end) {
  const PlaceTag d;
  const hn::RebindToSigned<PlaceTag> d_signed;
  const hn::Rebind<std::uint8_t, PlaceTag> d_u8;
  const int n = static_cast<int>(hn::Lanes(d)), w = dst.width();
  const auto stride = static_cast<std::uint32_t>(src.stride());

  const auto ends = [&](auto word) {
    return hn::Or(hn::And(word, hn::Set(d, 0xFF)), hn::And(hn::ShiftRight<8>(word), hn::Set(d, 0xFF0000)));
  };
  const auto greens = [&](auto first, auto last) {
    return hn::Or(hn::And(hn::ShiftRight<8>(first), hn::Set(d, 0xFF)), hn::And(last, hn::Set(d, 0xFF0000)));
  };
  const auto vector = [&](const std::uint32_t* corner_row, const std::uint16_t* fraction_row, Rgb8* out) {
    const Place p(corner_row, fraction_row);
    const auto words = [&](auto y, int bytes) {
      const auto pixel = hn::Add(hn::Mul(y, hn::Set(d, stride)), p.x0);
      const auto at = hn::BitCast(d_signed, hn::Mul(pixel, hn::Set(d, 3)));
      return hn::GatherOffset(d, reinterpret_cast<const std::uint32_t*>(&src.data()->r + bytes), at);
    };
    // Where columns is not kLinear, y0 may be the last row.
    const auto below = hn::Min(hn::Add(p.y0, hn::Set(d, 1)), hn::Set(d, static_cast<std::uint32_t>(src.height() - 1)));
    const auto top = words(p.y0, 0), top_last = words(p.y0, 2), bottom = words(below, 0), bottom_last = words(below, 2);
    hn::StoreInterleaved3(p.value(ends(top), ends(bottom)), p.value(greens(top, top_last), greens(bottom, bottom_last)),
                          p.value(ends(top_last), ends(bottom_last)), d_u8, &out->r);
  };

  for (int y = y_begin; y < y_end; ++y) {
    const std::uint32_t* corner = map.corner.row(y);
    const std::uint16_t* fraction = map.fraction_q8.row(y);
    if (w >= n) {
      for (int x = 0; x + n < w; x += n) vector(corner + x, fraction + x, dst.row(y) + x);
      vector(corner + w - n, fraction + w - n, dst.row(y) + w - n);
      continue;
    }
    HWY_ALIGN std::uint32_t some_corners[hn::MaxLanes(d)];
    HWY_ALIGN std::uint16_t some_fractions[hn::MaxLanes(d)] = {};
    Rgb8 values[hn::MaxLanes(d)];
    std::fill_n(some_corners, n, ResampleMap::kOutside);
    std::copy_n(corner, w, some_corners);
    std::copy_n(fraction, w, some_fractions);
    vector(some_corners, some_fractions, values);
    std::copy_n(values, w, dst.row(y));
  }
}

}  // namespace duo::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace duo {
HWY_EXPORT(rectify_rows);
HWY_EXPORT(rectify_color_rows);

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
  if (map.columns == ResampleMap::Columns::kSoft) {
    DUO_CHECK(src.size() == dst.size());
    for (int y = 0; y < dst.height(); ++y) std::copy_n(src.row(y), dst.width(), dst.row(y));
    return;
  }
  DUO_CHECK(src.width() >= 2 && src.height() >= 2 && 3 * src.stride() * src.height() < (std::int64_t{1} << 31));
  const auto rows = HWY_DYNAMIC_DISPATCH(rectify_color_rows);
  pool.rows(dst.height(), [&](int begin, int end) { rows(src, map, dst, begin, end); });
}

}  // namespace simd
}  // namespace duo
#endif
