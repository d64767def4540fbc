#include "stages/match_tiles/channels_simd.h"

#include <algorithm>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "stages/match_tiles/channels_simd.cpp"
#include <hwy/foreach_target.h>
// After foreach_target.h, as Highway asks.
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace duo::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// Both gradients of one row, clipped, plus 128.
void sobel_row(const std::uint8_t* up, const std::uint8_t* mid, const std::uint8_t* down, int w, int clip, std::uint8_t* out_x,
               std::uint8_t* out_y) {
  const hn::ScalableTag<std::int16_t> d16;
  const hn::Rebind<std::uint8_t, decltype(d16)> d8;
  const int n = static_cast<int>(hn::Lanes(d16));
  const auto low = hn::Set(d16, static_cast<std::int16_t>(-clip)), high = hn::Set(d16, static_cast<std::int16_t>(clip));
  const auto middle = hn::Set(d16, 128);
  const auto load = [&](const std::uint8_t* p) HWY_ATTR { return hn::PromoteTo(d16, hn::LoadU(d8, p)); };
  const auto store = [&](auto sobel, std::uint8_t* p) HWY_ATTR {
    hn::StoreU(hn::DemoteTo(d8, hn::Add(hn::Min(hn::Max(sobel, low), high), middle)), d8, p);
  };
  const auto vector = [&](int x) HWY_ATTR {
    const auto ul = load(up + x - 1), ur = load(up + x + 1), dl = load(down + x - 1), dr = load(down + x + 1);
    const auto diagonal = hn::Sub(dr, ul), other = hn::Sub(dl, ur);  // both gradients are made of these two
    store(hn::Add(hn::Sub(diagonal, other), hn::ShiftLeft<1>(hn::Sub(load(mid + x + 1), load(mid + x - 1)))), out_x + x);
    store(hn::Add(hn::Add(diagonal, other), hn::ShiftLeft<1>(hn::Sub(load(down + x), load(up + x)))), out_y + x);
  };
  const auto plain = [&](int x) {
    const int l = std::max(x - 1, 0), r = std::min(x + 1, w - 1);
    const int diagonal = down[r] - up[l], other = down[l] - up[r];
    const auto clipped = [&](int v) { return static_cast<std::uint8_t>(std::clamp(v, -clip, clip) + 128); };
    out_x[x] = clipped(diagonal - other + 2 * (mid[r] - mid[l]));
    out_y[x] = clipped(diagonal + other + 2 * (down[x] - up[x]));
  };
  plain(0);
  if (w < n + 2) {
    for (int x = 1; x < w; ++x) plain(x);
    return;
  }
  for (int x = 1; x + n < w - 1; x += n) vector(x);
  vector(w - 1 - n);  // overlaps the one before: same values
  plain(w - 1);
}

/// Interval of each value and the half-way values towards the neighbours, each given as a row; rows are padded by a vector.
void interval_row(const std::uint8_t* value, const std::uint8_t* const* neighbours, int count, int w, std::uint8_t* low,
                  std::uint8_t* high) {
  const hn::ScalableTag<std::uint8_t> d;
  for (int x = 0; x < w; x += static_cast<int>(hn::Lanes(d))) {
    const auto v = hn::LoadU(d, value + x);
    auto lo = v, hi = v;
    for (int i = 0; i < count; ++i) {
      const auto half = hn::AverageRound(v, hn::LoadU(d, neighbours[i] + x));
      lo = hn::Min(lo, half);
      hi = hn::Max(hi, half);
    }
    hn::StoreU(lo, d, low + x);
    hn::StoreU(hi, d, high + x);
  }
}

void halve_gray_row(const std::uint8_t* in, int w, std::uint8_t* out) {
  const hn::ScalableTag<std::uint8_t> d;
  const hn::Repartition<std::uint16_t, decltype(d)> d16;
  const auto keep = hn::Set(d, 0x7F);
  int x = 0;
  for (; x + static_cast<int>(hn::Lanes(d)) <= w; x += static_cast<int>(hn::Lanes(d)))
    hn::StoreU(hn::And(hn::BitCast(d, hn::ShiftRight<1>(hn::BitCast(d16, hn::LoadU(d, in + x)))), keep), d, out + x);
  for (; x < w; ++x) out[x] = in[x] >> 1;
}

}  // namespace duo::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace duo {
HWY_EXPORT(sobel_row);
HWY_EXPORT(interval_row);
HWY_EXPORT(halve_gray_row);

namespace simd {
namespace {

/// Continues a row by its edge pixels over the padding on both sides.
void continue_edges(Image<std::uint8_t>& plane, int y, int pad_left, int w) {
  std::uint8_t* row = plane.row(y);
  std::fill_n(row, pad_left, row[pad_left]);
  std::fill(row + pad_left + w, row + plane.width(), row[pad_left + w - 1]);
}

/// Overwrites pixels of row y whose 3x3 neighbourhood is not all inside.
template <class Mark>
void mark_outside(View<const std::uint8_t> inside, int y, Mark mark) {
  const int w = inside.width(), h = inside.height();
  const std::uint8_t* rows[3] = {inside.row(std::max(y - 1, 0)), inside.row(y), inside.row(std::min(y + 1, h - 1))};
  const auto column = [&](int x) { return rows[0][x] & rows[1][x] & rows[2][x]; };
  int before = column(0), here = before;
  for (int x = 0; x < w; ++x) {
    const int after = column(std::min(x + 1, w - 1));
    if ((before & here & after) == 0) mark(x);
    before = here;
    here = after;
  }
}

/// Gray and gradients of row y, edges continued.
void channel_row(View<const std::uint8_t> gray, int y, int clip, int pad, MatchTilesScratch::Channels& out) {
  const int w = gray.width();
  const std::uint8_t *up = gray.row(std::max(y - 1, 0)), *down = gray.row(std::min(y + 1, gray.height() - 1));
  HWY_DYNAMIC_DISPATCH(halve_gray_row)(gray.row(y), w, out.gray.row(y) + pad);
  HWY_DYNAMIC_DISPATCH(sobel_row)(up, gray.row(y), down, w, clip, out.sobel_x.row(y) + pad, out.sobel_y.row(y) + pad);
  for (Image<std::uint8_t>* plane : {&out.gray, &out.sobel_x, &out.sobel_y}) continue_edges(*plane, y, pad, w);
}

/// Intervals of the right gradients of row y, edges continued.
void interval_rows(MatchTilesScratch& s, int y, int w) {
  const int h = s.right.gray.height(), pad = s.pad_left;
  const std::uint8_t *x = s.right.sobel_x.row(y) + pad, *v = s.right.sobel_y.row(y) + pad;
  const std::uint8_t* beside[2] = {x - 1, x + 1};
  const std::uint8_t* around[4] = {v - 1, v + 1, s.right.sobel_y.row(std::max(y - 1, 0)) + pad,
                                   s.right.sobel_y.row(std::min(y + 1, h - 1)) + pad};
  HWY_DYNAMIC_DISPATCH(interval_row)(x, beside, 2, w, s.sobel_x_low.row(y) + pad, s.sobel_x_high.row(y) + pad);
  HWY_DYNAMIC_DISPATCH(interval_row)(v, around, 4, w, s.sobel_y_low.row(y) + pad, s.sobel_y_high.row(y) + pad);
}

}  // namespace

void make_channels(Pool& pool, const GrayPair& pair, int sobel_clip, MatchTilesScratch& s) {
  const int w = pair.size().width, pad = s.pad_left;
  pool.rows(pair.size().height, [&](int begin, int end) {
    for (int y = begin; y < end; ++y) {
      channel_row(pair.left, y, sobel_clip, pad, s.left);
      channel_row(pair.right, y, sobel_clip, pad, s.right);
      if (!pair.masked()) continue;
      mark_outside(pair.left_inside, y, [&](int x) {
        s.left.gray.row(y)[pad + x] = kLeftOutsideGray;
        s.left.sobel_x.row(y)[pad + x] = s.left.sobel_y.row(y)[pad + x] = kLeftOutsideSobel;
      });
      mark_outside(pair.right_inside, y, [&](int x) { s.right.gray.row(y)[pad + x] = kRightOutsideGray; });
      for (Image<std::uint8_t>* plane : {&s.left.gray, &s.left.sobel_x, &s.left.sobel_y, &s.right.gray}) continue_edges(*plane, y, pad, w);
    }
  });
  // Vertical intervals read the rows above and below: only now are all of them there.
  pool.rows(pair.size().height, [&](int begin, int end) {
    for (int y = begin; y < end; ++y) {
      interval_rows(s, y, w);
      if (pair.masked())
        mark_outside(pair.right_inside, y, [&](int x) {
          s.sobel_x_low.row(y)[pad + x] = s.sobel_y_low.row(y)[pad + x] = kRightOutsideLow;
          s.sobel_x_high.row(y)[pad + x] = s.sobel_y_high.row(y)[pad + x] = kRightOutsideHigh;
        });
      for (Image<std::uint8_t>* plane : {&s.sobel_x_low, &s.sobel_x_high, &s.sobel_y_low, &s.sobel_y_high}) continue_edges(*plane, y, pad, w);
    }
  });
}

}  // namespace simd
}  // namespace duo
#endif
