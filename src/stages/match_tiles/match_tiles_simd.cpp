// Lanes are pixels. A tile with its margins is 64 bytes wide; for each candidate its 26 rows of pixel costs are summed along x in
// bytes (7 * 36 < 256), then down the rows in 16 bits as a running sum, then the least of the shifted windows goes to
// [row][candidate][x] memory that stays in the cache. Winners are then picked with all their state in registers.

#include <algorithm>
#include <bit>

#include "core/check.h"
#include "stages/match_tiles/channels_simd.h"
#include "stages/match_tiles/match_tiles.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "stages/match_tiles/match_tiles_simd.cpp"
#include <hwy/foreach_target.h>
// After foreach_target.h, as Highway asks.
#include <hwy/highway.h>

#ifndef DUO_MATCH_TILES_GEOMETRY
#define DUO_MATCH_TILES_GEOMETRY
namespace duo {
constexpr int kTile = TileSets::kWidth, kRows = TileSets::kHeight;
constexpr int kPatch = 64;                 // bytes of a patch row: pixels x0 - kMargin .. x0 + 55
constexpr int kMargin = 8;                 // 3 for the window, 3 for its shifts, 2 to spare
constexpr int kReachY = 3 + 2;             // window and shifts, rows
constexpr int kCostRows = kRows + 2 * kReachY, kWindowRows = kRows + 4;
constexpr std::int16_t kNoCost = 0x7FFF;   // more than any sum; OR with it makes any cost "none"
// Window sums are kept at index i for the window centred on patch column i + 3; output pixel j is patch column j + kMargin,
// so the window centred on it has index j + kCentre.
constexpr int kCentre = kMargin - 3;
}  // namespace duo
#endif

HWY_BEFORE_NAMESPACE();
namespace duo::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;
using D8 = hn::CappedTag<std::uint8_t, kPatch>;
using D16 = hn::CappedTag<std::int16_t, kTile>;

/// One tile at (y0, x0), all of its candidates.
class Tile {
 public:
  Tile(const simd::MatchTilesScratch& s, const MatchTilesParams& params, const TileMatch& out, simd::MatchTilesScratch::Band& band, int y0)
      : s_(s), params_(params), out_(out), band_(band), y0_(y0), w_(out.left.width()), h_(out.left.height()) {
    row_stride_ = band.costs.stride();
  }

  void match(int x0, const std::uint64_t* set, int words) {
    x0_ = x0;
    rows_ = std::min(kRows, h_ - y0_);
    list_candidates(set, words);
    for (int j = 0; j < kPatch; ++j) {
      const int centre = x0 + j - kCentre;  // of the window with index j
      no_window_[j] = centre < 0 || centre >= w_ ? kNoCost : std::int16_t{0};
      no_pixel_[j] = j >= kTile || x0 + j >= w_ ? kNoCost : std::int16_t{0};
    }
    for (int k = 0; k < count_; ++k) {
      sum_windows(band_.candidates[static_cast<std::size_t>(k)]);
      shift_windows(k);
    }
    for (int y = 0; y < rows_; ++y) {
      pick_right(y);
      pick_left(y);
    }
  }

 private:
  void list_candidates(const std::uint64_t* set, int words) {
    // No pixel of the tile can have x >= d beyond its last column.
    const int last = std::min(x0_ + kTile, w_) - 1;
    count_ = 0;
    for (int i = 0; i < words; ++i)
      for (std::uint64_t bits = set[i]; bits != 0; bits &= bits - 1)
        if (const int d = 64 * i + std::countr_zero(bits); d <= last) band_.candidates[static_cast<std::size_t>(count_++)] = static_cast<std::int16_t>(d);
  }

  /// Costs of one row of the patch, summed over seven columns.
  HWY_INLINE void sum_row(int row, int d, std::uint8_t* HWY_RESTRICT sums) const {
    const D8 d8;
    const int y = std::clamp(y0_ + row - kReachY, 0, h_ - 1), n = static_cast<int>(hn::Lanes(d8));
    const std::ptrdiff_t left = s_.pad_left + x0_ - kMargin, right = left - d;
    const auto truncation = hn::Set(d8, static_cast<std::uint8_t>(params_.truncation));
    HWY_ALIGN_MAX std::uint8_t cost[2 * kPatch], two[2 * kPatch], four[2 * kPatch];
    const auto add = [&](const std::uint8_t* a, const std::uint8_t* b, std::uint8_t* out) HWY_ATTR {
      for (int i = 0; i < kPatch; i += n) hn::Store(hn::Add(hn::Load(d8, a + i), hn::LoadU(d8, b + i)), d8, out + i);
    };
    const std::uint8_t *lg = s_.left.gray.row(y) + left, *lx = s_.left.sobel_x.row(y) + left, *ly = s_.left.sobel_y.row(y) + left;
    const std::uint8_t* rg = s_.right.gray.row(y) + right;
    const std::uint8_t *x_low = s_.sobel_x_low.row(y) + right, *x_high = s_.sobel_x_high.row(y) + right;
    const std::uint8_t *y_low = s_.sobel_y_low.row(y) + right, *y_high = s_.sobel_y_high.row(y) + right;
    for (int i = 0; i < kPatch; i += n) {
      const auto distance = [&](const std::uint8_t* value, const std::uint8_t* low, const std::uint8_t* high) HWY_ATTR {
        const auto v = hn::LoadU(d8, value + i);
        return hn::Min(hn::Or(hn::SaturatedSub(v, hn::LoadU(d8, high + i)), hn::SaturatedSub(hn::LoadU(d8, low + i), v)), truncation);
      };
      hn::Store(hn::Add(hn::Add(distance(lg, rg, rg), distance(lx, x_low, x_high)), distance(ly, y_low, y_high)), d8, cost + i);
    }
    // Sums of 2, 4, then 7 = 4 + 2 + 1; what the last six columns add up from beyond the patch is never used.
    add(cost, cost + 1, two);
    add(two, two + 2, four);
    for (int i = 0; i < kPatch; i += n)
      hn::Store(hn::Add(hn::Add(hn::Load(d8, four + i), hn::LoadU(d8, two + i + 4)), hn::LoadU(d8, cost + i + 6)), d8, sums + i);
  }

  /// windows_[r]: 7x7 sums of the window row centred on picture row y0 - 2 + r.
  void sum_windows(int d) {
    const D16 d16;
    const hn::Rebind<std::uint8_t, D16> d8;
    for (int row = 0; row < kCostRows; ++row) sum_row(row, d, row_sums_[row]);
    for (int i = 0; i < kPatch; i += static_cast<int>(hn::Lanes(d16))) {
      const auto load = [&](int row) HWY_ATTR { return hn::PromoteTo(d16, hn::Load(d8, row_sums_[row] + i)); };
      auto sum = load(0);
      for (int row = 1; row < 7; ++row) sum = hn::Add(sum, load(row));
      hn::Store(sum, d16, windows_[0] + i);
      for (int row = 1; row < kWindowRows; ++row) {
        sum = hn::Add(sum, hn::Sub(load(row + 6), load(row - 1)));
        hn::Store(sum, d16, windows_[row] + i);
      }
    }
  }

  std::int16_t* costs_of(int y, int k) { return band_.costs.row(0) + y * row_stride_ + k * kPatch; }

  /// The least of the shifted windows, to the tile's memory as candidate k.
  void shift_windows(int k) {
    const D16 d16;
    const int n = static_cast<int>(hn::Lanes(d16)), d = band_.candidates[static_cast<std::size_t>(k)];
    HWY_ALIGN_MAX std::int16_t column[2 * kPatch];
    for (int y = 0; y < rows_; ++y) {
      // A window centred outside the picture does not count; repeating the middle one in its place changes nothing.
      const std::int16_t* middle = windows_[y + 2];
      const std::int16_t* above = y0_ + y - 2 >= 0 ? windows_[y] : middle;
      const std::int16_t* below = y0_ + y + 2 < h_ ? windows_[y + 4] : middle;
      for (int i = 0; i < kPatch; i += n) {
        const auto least = hn::Min(hn::Min(hn::Load(d16, above + i), hn::Load(d16, below + i)), hn::Load(d16, middle + i));
        hn::Store(hn::Or(least, hn::Load(d16, no_window_ + i)), d16, column + i);
      }
      std::int16_t* out = costs_of(y, k);
      const std::int16_t* centre = column + kCentre;
      for (int j = 0; j < kTile; j += n) {
        const auto at = [&](int shift) HWY_ATTR { return hn::LoadU(d16, centre + j + shift); };
        const auto least = params_.wide_shifts ? hn::Min(hn::Min(at(-3), at(-1)), hn::Min(at(1), at(3))) : hn::Min(hn::Min(at(-2), at(0)), at(2));
        hn::Store(hn::Max(least, hn::Load(d16, no_pixel_ + j)), d16, out + j);  // lanes past the patch hold anything
      }
      if (d > x0_) std::fill_n(out, std::min(kTile, d - x0_), kNoCost);  // x < d: not tried
    }
  }

  /// Lowers the right view's best costs; candidates rise, tiles go left to right: the smallest d keeps a tie.
  void pick_right(int y) {
    const D16 d16;
    std::int16_t *best = band_.right_cost.row(y) + s_.pad_left + x0_, *winner = band_.right.row(y) + s_.pad_left + x0_;
    for (int k = 0; k < count_; ++k) {
      const std::int16_t* cost = costs_of(y, k);
      const int d = band_.candidates[static_cast<std::size_t>(k)];
      const auto value = hn::Set(d16, static_cast<std::int16_t>(d));
      for (int j = 0; j < kTile; j += static_cast<int>(hn::Lanes(d16))) {
        const auto c = hn::Load(d16, cost + j), b = hn::LoadU(d16, best + j - d);
        const auto better = hn::Lt(c, b);
        hn::StoreU(hn::Min(c, b), d16, best + j - d);
        hn::StoreU(hn::IfThenElse(better, value, hn::LoadU(d16, winner + j - d)), d16, winner + j - d);
      }
    }
  }

  void pick_left(int y) {
    const D16 d16;
    const hn::RebindToUnsigned<D16> du16;
    const auto none = hn::Set(d16, kNoCost);
    HWY_ALIGN_MAX std::int16_t left[kPatch];
    HWY_ALIGN_MAX std::uint16_t fine[kPatch];
    for (int j = 0; j < kTile; j += static_cast<int>(hn::Lanes(d16))) {
      auto best = none, winner = hn::Set(d16, -1), before = none, after = none, last = none;
      int last_d = -2;
      for (int k = 0; k < count_; ++k) {
        const int d = band_.candidates[static_cast<std::size_t>(k)];
        const auto cost = hn::Load(d16, costs_of(y, k) + j);
        if (d != last_d + 1)
          last = none;
        else
          after = hn::IfThenElse(hn::Eq(winner, hn::Set(d16, static_cast<std::int16_t>(last_d))), cost, after);
        const auto better = hn::Lt(cost, best);
        best = hn::Min(best, cost);
        winner = hn::IfThenElse(better, hn::Set(d16, static_cast<std::int16_t>(d)), winner);
        before = hn::IfThenElse(better, last, before);
        after = hn::IfThenElse(better, none, after);
        last = cost;
        last_d = d;
      }
      hn::Store(winner, d16, left + j);
      const auto q4 = hn::Add(hn::ShiftLeft<4>(winner), sub_pixel(before, best, after));
      const auto known = hn::Gt(winner, hn::Set(d16, -1));
      hn::Store(hn::BitCast(du16, hn::IfThenElse(known, q4, hn::Set(d16, -1))), du16, fine + j);  // -1 is Disparity::kNone
    }
    const int count = std::min(kTile, w_ - x0_);
    std::copy_n(left, count, out_.left.row(y0_ + y) + x0_);
    std::copy_n(fine, count, out_.fine.row(y0_ + y) + x0_);
  }

  /// round(8 (before - after) / (max(before, after) - best)), half away from zero. The quotient is at most 8 in size, so it is
  /// counted instead of divided: |8 (before - after)| + height / 2 >= k * height for how many k in 1 .. 8. All below 2^15.
  template <class V>
  static HWY_INLINE V sub_pixel(V before, V best, V after) {
    const D16 d16;
    const auto none = hn::Set(d16, kNoCost), zero = hn::Zero(d16);
    const auto height = hn::Sub(hn::Max(before, after), best);
    const auto rounded = hn::Add(hn::ShiftLeft<3>(hn::Abs(hn::Sub(before, after))), hn::ShiftRight<1>(height));
    auto offset = hn::Set(d16, 8), step = height;
    for (int k = 1; k <= 8; ++k) {
      offset = hn::Add(offset, hn::VecFromMask(d16, hn::Lt(rounded, step)));  // a true lane is -1
      step = hn::Add(step, height);
    }
    offset = hn::IfThenElse(hn::Lt(before, after), hn::Neg(offset), offset);
    const auto usable = hn::And(hn::And(hn::Ne(before, none), hn::Ne(after, none)), hn::Gt(height, zero));
    return hn::IfThenElseZero(usable, offset);
  }

  const simd::MatchTilesScratch& s_;
  const MatchTilesParams& params_;
  const TileMatch& out_;
  simd::MatchTilesScratch::Band& band_;
  int y0_, w_, h_;
  int x0_ = 0, rows_ = 0, count_ = 0;
  std::ptrdiff_t row_stride_;
  HWY_ALIGN_MAX std::uint8_t row_sums_[kCostRows][kPatch];
  HWY_ALIGN_MAX std::int16_t windows_[kWindowRows][kPatch];
  HWY_ALIGN_MAX std::int16_t no_window_[kPatch], no_pixel_[kPatch];
};

/// Rows [y_begin, y_end), whole bands of tiles.
void match_bands(const TileSets& sets, const MatchTilesParams& params, const simd::MatchTilesScratch& s, simd::MatchTilesScratch::Band& band,
                 const TileMatch& out, int y_begin, int y_end) {
  const int w = out.left.width();
  for (int y0 = y_begin; y0 < y_end; y0 += kRows) {
    const int rows = std::min(kRows, y_end - y0);
    for (int y = 0; y < rows; ++y) {
      std::fill_n(band.right_cost.row(y), band.right_cost.width(), kNoCost);
      std::fill_n(band.right.row(y), band.right.width(), std::int16_t{-1});
    }
    Tile tile(s, params, out, band, y0);
    for (int x0 = 0; x0 < w; x0 += kTile) tile.match(x0, sets.of(y0 / kRows, x0 / kTile), sets.words.width());
    for (int y = 0; y < rows; ++y) std::copy_n(band.right.row(y) + s.pad_left, w, out.right.row(y0 + y));
  }
}

}  // namespace duo::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace duo {
HWY_EXPORT(match_bands);

namespace simd {

MatchTilesScratch::MatchTilesScratch(Size size, int max_disparity, int threads) : pad_left(max_disparity + kPatch) {
  // The last tile reads up to x0 - kMargin + kPatch + a vector.
  const Size padded{pad_left + (size.width + kTile - 1) / kTile * kTile + 2 * kPatch, size.height};
  for (Channels* c : {&left, &right})
    for (Image<std::uint8_t>* plane : {&c->gray, &c->sobel_x, &c->sobel_y}) *plane = Image<std::uint8_t>(padded);
  for (Image<std::uint8_t>* plane : {&sobel_x_low, &sobel_x_high, &sobel_y_low, &sobel_y_high}) *plane = Image<std::uint8_t>(padded);
  bands.resize(static_cast<std::size_t>(threads));
  for (Band& band : bands) {
    band.costs = Image<std::int16_t>({max_disparity * kPatch + 32, kRows});  // 32 more: rows must not fall on the same cache sets
    band.right_cost = Image<std::int16_t>({padded.width, kRows});
    band.right = Image<std::int16_t>({padded.width, kRows});
    band.candidates.resize(static_cast<std::size_t>(max_disparity));
  }
}

void match_tiles(Pool& pool, const GrayPair& pair, const TileSets& sets, const MatchTilesParams& params, MatchTilesScratch& scratch,
                 const TileMatch& out) {
  DUO_CHECK(sets.tiles == TileSets::tiles_of(pair.size()) && out.left.size() == pair.size());
  DUO_CHECK(params.truncation >= 1 && params.truncation <= 12 && params.sobel_clip >= 1 && params.sobel_clip <= 63);
  DUO_CHECK(scratch.pad_left >= sets.max_disparity + kPatch && static_cast<int>(scratch.bands.size()) >= pool.threads());
  make_channels(pool, pair, params.sobel_clip, scratch);
  const auto match = HWY_DYNAMIC_DISPATCH(match_bands);
  pool.rows(pair.size().height, [&](int begin, int end, int part) {
    match(sets, params, scratch, scratch.bands[static_cast<std::size_t>(part)], out, begin, end);
  }, kRows);
}

}  // namespace simd
}  // namespace duo
#endif
