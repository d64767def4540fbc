// Lanes are pixels of a row of the square.

#include <algorithm>

#include "core/check.h"
#include "stages/crop_square16/crop_grid.h"
#include "stages/crop_square16/crop_square16.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "stages/crop_square16/crop_square16_simd.cpp"
#include <hwy/foreach_target.h>
// After foreach_target.h, as Highway asks.
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace duo::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// Vectors of pixels of one picture.
class CropVectors {
 public:
  using D = hn::CappedTag<std::int32_t, 16>;
  using V = hn::Vec<D>;

  CropVectors(View<const Rgb8> picture, Outside outside, int offset)
      : words_(reinterpret_cast<const std::int32_t*>(picture.data())),
        right_(picture.width() - 1),
        bottom_(picture.height() - 1),
        stride_(3 * static_cast<int>(picture.stride())),
        last_word_(bottom_ * stride_ + 3 * picture.width() - 4),
        offset_(offset),
        black_(outside == Outside::kBlack) {}

  /// Pixels that lie at (px, py), 1/65536 px, as three channels each.
  HWY_INLINE void at(V px, V py, std::int16_t* out) const {
    const D d;
    const hn::Rebind<std::int16_t, D> d16;
    const auto one = hn::Set(d, 1);
    const V x = hn::ShiftRight<16>(px), y = hn::ShiftRight<16>(py), x_after = hn::Add(x, one), y_after = hn::Add(y, one);
    const V left = bytes(clamped(x, right_), 3), right = bytes(clamped(x_after, right_), 3);
    const V upper = bytes(clamped(y, bottom_), stride_), lower = bytes(clamped(y_after, bottom_), stride_);
    V a = pixels(hn::Add(upper, left)), b = pixels(hn::Add(upper, right));
    V c = pixels(hn::Add(lower, left)), e = pixels(hn::Add(lower, right));
    if (black_) {
      const V left_in = inside(x, right_), right_in = inside(x_after, right_);
      const V upper_in = inside(y, bottom_), lower_in = inside(y_after, bottom_);
      a = hn::And(a, hn::And(upper_in, left_in)), b = hn::And(b, hn::And(upper_in, right_in));
      c = hn::And(c, hn::And(lower_in, left_in)), e = hn::And(e, hn::And(lower_in, right_in));
    }
    const auto low7 = hn::Set(d, 127);
    const V fx = hn::And(hn::ShiftRight<9>(px), low7), fy = hn::And(hn::ShiftRight<9>(py), low7);
    const V across = hn::Or(hn::Sub(hn::Set(d, 128), fx), hn::ShiftLeft<16>(fx));  // weights of a pair
    const auto channel = [&](V upper_pair, V lower_pair) HWY_ATTR {
      const V top = weighed(upper_pair, across), below = weighed(lower_pair, across);
      const V sum = hn::Add(hn::ShiftLeft<7>(top), hn::Mul(hn::Sub(below, top), fy));
      return hn::DemoteTo(d16, hn::Add(hn::ShiftRight<7>(hn::Add(sum, hn::Set(d, 64))), hn::Set(d, offset_)));
    };
    const auto low8 = hn::Set(d, 0xFF), high8 = hn::Set(d, 0xFF0000);
    const auto reds = [&](V p, V q) HWY_ATTR { return hn::Or(hn::And(p, low8), hn::And(hn::ShiftLeft<16>(q), high8)); };
    const auto greens = [&](V p, V q) HWY_ATTR {
      return hn::Or(hn::And(hn::ShiftRight<8>(p), low8), hn::And(hn::ShiftLeft<8>(q), high8));
    };
    const auto blues = [&](V p, V q) HWY_ATTR { return hn::Or(hn::And(hn::ShiftRight<16>(p), low8), hn::And(q, high8)); };
    hn::StoreInterleaved3(channel(reds(a, b), reds(c, e)), channel(greens(a, b), greens(c, e)),
                          channel(blues(a, b), blues(c, e)), d16, out);
  }

 private:
  static HWY_INLINE V clamped(V v, int most) {
    const D d;
    return hn::Min(hn::Max(v, hn::Zero(d)), hn::Set(d, most));
  }
  static HWY_INLINE V inside(V v, int most) {
    const D d;
    return hn::VecFromMask(d, hn::Eq(v, clamped(v, most)));
  }
  static HWY_INLINE V bytes(V v, int each) { return hn::Mul(v, hn::Set(D(), each)); }

  /// Red, green, blue and one byte more. The picture's last pixel has none: from there a gather starts a byte earlier.
  HWY_INLINE V pixels(V at) const {
    const D d;
    const hn::RebindToUnsigned<D> du;
    const V from = hn::Min(at, hn::Set(d, last_word_));
    const auto word = hn::BitCast(du, hn::GatherOffset(d, words_, from));
    return hn::BitCast(d, hn::Shr(word, hn::BitCast(du, hn::ShiftLeft<3>(hn::Sub(at, from)))));
  }

  /// The sum of both halves of each lane, weighed: at most 255 * 128, so that products and sum fit 16 bits.
  static HWY_INLINE V weighed(V pair, V weights) {
    const D d;
    const hn::Repartition<std::int16_t, D> d_pairs;
    const V products = hn::BitCast(d, hn::Mul(hn::BitCast(d_pairs, pair), hn::BitCast(d_pairs, weights)));
    return hn::Add(hn::And(products, hn::Set(d, 0xFFFF)), hn::ShiftRight<16>(products));
  }

  const std::int32_t* words_;
  int right_, bottom_;      // the last column and row
  int stride_, last_word_;  // bytes
  int offset_;
  bool black_;
};

void crop_rows(View<const Rgb8> picture, const TurnedSquare& region, Outside outside, int offset, Tensor16 y, int begin,
               int end) {
  const CropVectors::D d;
  constexpr int kMost = static_cast<int>(hn::MaxLanes(CropVectors::D()));
  const int n = static_cast<int>(hn::Lanes(d)), side = y.width();
  const CropVectors vectors(picture, outside, offset);
  CropGrid grid(region, side);
  for (int i = begin; i < end; ++i) {
    grid.set_row(i);
    const auto row_x = hn::Set(d, grid.row_x()), row_y = hn::Set(d, grid.row_y());
    std::int16_t* const out = y.pixel(i, 0);
    int j = 0;
    for (; j + n <= side; j += n)
      vectors.at(hn::Add(hn::LoadU(d, grid.columns_x() + j), row_x), hn::Add(hn::LoadU(d, grid.columns_y() + j), row_y),
                 out + 3 * j);
    if (j == side) continue;
    HWY_ALIGN_MAX std::int32_t rest_x[kMost] = {}, rest_y[kMost] = {};
    std::int16_t rest[3 * kMost];
    std::copy(grid.columns_x() + j, grid.columns_x() + side, rest_x);
    std::copy(grid.columns_y() + j, grid.columns_y() + side, rest_y);
    vectors.at(hn::Add(hn::Load(d, rest_x), row_x), hn::Add(hn::Load(d, rest_y), row_y), rest);
    std::copy_n(rest, 3 * (side - j), out + 3 * j);
  }
}

}  // namespace duo::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace duo {
HWY_EXPORT(crop_rows);

void simd::crop_square16(Pool& pool, View<const Rgb8> picture, const TurnedSquare& region, Outside outside, int offset,
                         Tensor16 y) {
  DUO_CHECK(y.channels() == 3 && y.width() == y.height() && y.width() <= CropGrid::kMostSide && !picture.empty());
  if (picture.width() * picture.height() == 1) return ref::crop_square16(picture, region, outside, offset, y);  // no word
  const auto rows = HWY_DYNAMIC_DISPATCH(crop_rows);
  pool.rows(y.height(), [&](int begin, int end) { rows(picture, region, outside, offset, y, begin, end); });
}

}  // namespace duo
#endif
