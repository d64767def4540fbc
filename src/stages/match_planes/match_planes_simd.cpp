// Lanes are x. The gray plane is written first, edges continued, so that nothing below needs a border case along x.

#include <algorithm>

#include "core/check.h"
#include "stages/match_planes/match_planes.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "stages/match_planes/match_planes_simd.cpp"
#include <hwy/foreach_target.h>
// After foreach_target.h, as Highway asks.
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace duo::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// `rows` are the gray rows y - 2 .. y + 2 at x = 0; writes up to a vector beyond w.
void census_row(const std::uint8_t* const* rows, int w, int dead_zone, std::uint8_t* low, std::uint8_t* high) {
  const hn::CappedTag<std::uint8_t, PlaneImages::kPadRight> d;
  for (int x = 0; x < w; x += static_cast<int>(hn::Lanes(d))) {
    // What is less than this is darker by more than the dead zone; nothing is less than 0.
    const auto centre = hn::SaturatedSub(hn::LoadU(d, rows[2] + x), hn::Set(d, static_cast<std::uint8_t>(dead_zone)));
    for (int byte = 0; byte < 2; ++byte) {
      auto bits = hn::Zero(d);
      for (int k = 0; k < 8; ++k) {
        const int* at = kCensus[8 * byte + k];
        const auto neighbour = hn::LoadU(d, rows[2 + at[1]] + x + at[0]);
        // There is no byte "less" on every instruction set: the neighbour is darker where the greater of both is not it.
        const auto darker = hn::Ne(hn::Max(neighbour, centre), neighbour);
        bits = hn::Or(bits, hn::IfThenElseZero(darker, hn::Set(d, static_cast<std::uint8_t>(1 << k))));
      }
      hn::StoreU(bits, d, (byte == 0 ? low : high) + x);
    }
  }
}

void plane_sobel_row(const std::uint8_t* up, const std::uint8_t* mid, const std::uint8_t* down, int w, bool whole,
                     std::uint8_t* out_x, std::uint8_t* out_y) {
  const hn::CappedTag<std::int16_t, PlaneImages::kPadRight / 2> d16;
  const hn::Rebind<std::uint8_t, decltype(d16)> d8;
  const auto load = [&](const std::uint8_t* p) HWY_ATTR { return hn::PromoteTo(d16, hn::LoadU(d8, p)); };
  const int shift = whole ? 0 : 2;
  const auto most = hn::Set(d16, whole ? 127 : 63), least = hn::Neg(most);
  const auto store = [&](auto sum, std::uint8_t* p) HWY_ATTR {
    const auto clipped = hn::Min(hn::Max(hn::ShiftRightSame(sum, shift), least), most);
    hn::StoreU(hn::DemoteTo(d8, hn::Add(clipped, hn::Set(d16, 128))), d8, p);
  };
  for (int x = 0; x < w; x += static_cast<int>(hn::Lanes(d16))) {
    const auto ul = load(up + x - 1), ur = load(up + x + 1), dl = load(down + x - 1), dr = load(down + x + 1);
    const auto diagonal = hn::Sub(dr, ul), other = hn::Sub(dl, ur);  // both gradients are made of these two
    store(hn::Add(hn::Sub(diagonal, other), hn::ShiftLeft<1>(hn::Sub(load(mid + x + 1), load(mid + x - 1)))), out_x + x);
    store(hn::Add(hn::Add(diagonal, other), hn::ShiftLeft<1>(hn::Sub(load(down + x), load(up + x)))), out_y + x);
  }
}

void plane_interval_row(const std::uint8_t* up, const std::uint8_t* mid, const std::uint8_t* down, int w, int wider,
                        std::uint8_t* low, std::uint8_t* high) {
  const hn::CappedTag<std::uint8_t, PlaneImages::kPadRight> d;
  const auto more = hn::Set(d, static_cast<std::uint8_t>(wider));
  for (int x = 0; x < w; x += static_cast<int>(hn::Lanes(d))) {
    const auto v = hn::LoadU(d, mid + x);
    auto lo = v, hi = v;
    for (const std::uint8_t* neighbour : {mid - 1, mid + 1, up, down}) {
      const auto half = hn::AverageRound(v, hn::LoadU(d, neighbour + x));
      lo = hn::Min(lo, half);
      hi = hn::Max(hi, half);
    }
    hn::StoreU(hn::SaturatedSub(lo, more), d, low + x);
    hn::StoreU(hn::SaturatedAdd(hi, more), d, high + x);
  }
}

}  // namespace duo::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace duo {
HWY_EXPORT(census_row);
HWY_EXPORT(plane_sobel_row);
HWY_EXPORT(plane_interval_row);

namespace simd {
namespace {

/// Loops that compilers make vectors of. `columns` is a row with a column to spare on either side.
void outside_row(View<const std::uint8_t> inside, int y, std::uint8_t* columns, std::uint8_t* out) {
  const int w = inside.width(), h = inside.height();
  const std::uint8_t *up = inside.row(std::max(y - 1, 0)), *mid = inside.row(y), *down = inside.row(std::min(y + 1, h - 1));
  for (int x = 0; x < w; ++x) columns[x] = up[x] & mid[x] & down[x];
  columns[-1] = columns[0];
  columns[w] = columns[w - 1];
  for (int x = 0; x < w; ++x) out[x] = (columns[x - 1] & columns[x] & columns[x + 1]) != 0 ? 0 : 255;
}

}  // namespace

void match_planes(Pool& pool, View<const std::uint8_t> gray, View<const std::uint8_t> inside, int dead_zone, bool clear,
                  int rows_wanted, PlaneImages& out) {
  DUO_CHECK(gray.size() == out.size && (inside.empty() || inside.size() == out.size) && out.pad >= PlaneImages::kPadRight);
  const int w = gray.width(), h = gray.height(), pad = out.pad;
  const auto first = [&](int more) { return std::min(rows_wanted + more, h); };
  const auto row = [&](View<std::uint8_t> plane, int y) { return plane.row(std::clamp(y, 0, h - 1)) + pad; };
  const auto copy = [&](int begin, int end) {
    for (int y = begin; y < end; ++y) {
      std::copy_n(gray.row(y), w, row(out.value[0], y));
      out.continue_row(out.value[0], y);
      if (inside.empty())
        std::fill_n(row(out.outside, y), w, std::uint8_t{0});
      else
        outside_row(inside, y, row(out.low[0], y), row(out.outside, y));  // low[0] has nothing in it yet
      out.continue_row(out.outside, y);
    }
  };
  const auto compare = [&](int begin, int end) {
    for (int y = begin; y < end; ++y) {
      const std::uint8_t* rows[5];
      for (int i = 0; i < 5; ++i) rows[i] = row(out.value[0], y + i - 2);
      HWY_DYNAMIC_DISPATCH(census_row)(rows, w, dead_zone, row(out.census[0], y), row(out.census[1], y));
      HWY_DYNAMIC_DISPATCH(plane_sobel_row)(rows[1], rows[2], rows[3], w, clear, row(out.value[1], y), row(out.value[2], y));
      for (const View<std::uint8_t> plane : {out.census[0], out.census[1], out.value[1], out.value[2]})
        out.continue_row(plane, y);
    }
  };
  const auto span = [&](int begin, int end) {
    for (int y = begin; y < end; ++y)
      for (std::size_t c = 0; c < MatchPlanes::kChannels; ++c) {
        HWY_DYNAMIC_DISPATCH(plane_interval_row)
        (row(out.value[c], y - 1), row(out.value[c], y), row(out.value[c], y + 1), w, clear && c == 0 ? kClearGrayDeadZone : 0,
         row(out.low[c], y), row(out.high[c], y));
        out.continue_row(out.low[c], y);
        out.continue_row(out.high[c], y);
      }
  };
  if (pool.threads() > 1) {
    pool.rows(first(3), copy);
    pool.rows(first(1), compare);
    pool.rows(first(0), span);
    return;
  }
  // Each step reads what the step before has just written, while it is in the cache.
  constexpr int kBand = 8;
  for (int y = 0, copied = 0, compared = 0; y < first(0); y += kBand) {
    const int end = std::min(y + kBand, first(0));
    const auto go_on = [](const auto& step, int& done, int to) {
      step(done, to);
      done = to;
    };
    go_on(copy, copied, std::min(end + 3, first(3)));
    go_on(compare, compared, std::min(end + 1, first(1)));
    span(y, end);
  }
}

}  // namespace simd
}  // namespace duo
#endif
