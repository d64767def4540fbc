// Lanes are candidates. A 2x2 block of pixels shares its base disparity (twice that of the one pixel below it), so one
// 8x8 patch of pixel costs serves four 7x7 windows: 64 costs instead of 196. The next block on the row shares six of its
// eight columns; where it has the same base too, only two columns are computed anew.

#include <algorithm>
#include <limits>

#include "core/check.h"
#include "stages/match_around/match_around.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "stages/match_around/match_around_simd.cpp"
#include <hwy/foreach_target.h>
// After foreach_target.h, as Highway asks.
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace duo::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

constexpr int kPad = simd::MatchAroundScratch::kPad;
constexpr int kLanes = 32;  // candidates of one step, in as many vectors as the target needs
constexpr int kColumns = 8;
using Sums16 = hn::CappedTag<std::uint16_t, kLanes>;
using Costs8 = hn::Rebind<std::uint8_t, Sums16>;

/// Sums over 7 rows of each column of the patch, for the block's upper and lower window.
struct ColumnSums {
  HWY_ALIGN_MAX std::uint16_t sum[kColumns][2][kLanes];
};

template <bool kMasked>
struct Block {
  const MatchAround& in;
  const simd::MatchAroundScratch& scratch;
  int y0;
  const std::uint8_t* left_row[kColumns];
  const std::uint8_t* inside_row[kColumns];
  const std::uint8_t* right_row[kColumns];
  const std::uint8_t* half_row[kColumns];
  const std::uint8_t* outside_row[kColumns];

  Block(const MatchAround& input, const simd::MatchAroundScratch& rows, int y) : in(input), scratch(rows), y0(y) {
    for (int i = 0; i < kColumns; ++i) {
      const int yy = std::clamp(y0 + i - 3, 0, in.left.height() - 1);
      left_row[i] = in.left.row(yy);
      right_row[i] = scratch.right.row(yy);
      half_row[i] = scratch.half.row(yy);
      if constexpr (kMasked) {
        inside_row[i] = in.left_inside.row(yy);
        outside_row[i] = scratch.outside.row(yy);
      }
    }
  }

  /// Costs of picture column x against candidates first_d .. first_d + 31, summed over rows.
  void column(int x, int first_d, std::uint16_t (*sums)[kLanes]) const {
    const Sums16 d16;
    const Costs8 d8;
    const int w = in.left.width();
    const int xl = std::clamp(x, 0, w - 1);
    // Mirrored: x - d of candidate d lies at w - 1 - (x - d) + kPad. Past the ends everything equals the edge pixel.
    const int start = std::clamp(w - 1 - x + first_d + kPad, 1, w + 2 * kPad - kLanes - 1);
    for (int lane = 0; lane < kLanes; lane += static_cast<int>(hn::Lanes(d16))) {
      const auto cost = [&](int i) {
        const auto l = hn::Set(d8, left_row[i][xl]);
        const auto difference = [&](auto r) { return hn::Or(hn::SaturatedSub(l, r), hn::SaturatedSub(r, l)); };
        const std::uint8_t* half = half_row[i] + start + lane;
        auto least = difference(hn::LoadU(d8, right_row[i] + start + lane));
        least = hn::Min(least, difference(hn::LoadU(d8, half)));
        least = hn::Min(least, difference(hn::LoadU(d8, half - 1)));
        if constexpr (kMasked) {
          least = hn::Or(least, hn::LoadU(d8, outside_row[i] + start + lane));
          least = hn::Or(least, hn::Set(d8, static_cast<std::uint8_t>(~inside_row[i][xl])));
        }
        return hn::PromoteTo(d16, least);
      };
      const auto top = cost(0);
      auto middle = cost(1);
      for (int i = 2; i < kColumns - 1; ++i) middle = hn::Add(middle, cost(i));
      hn::Store(hn::Add(top, middle), d16, sums[0] + lane);
      hn::Store(hn::Add(middle, cost(kColumns - 1)), d16, sums[1] + lane);
    }
  }

  /// Best of the candidates first_d + [begin, end) for the window whose first column is `column0`; keeps the better of it and
  /// what `best` holds, the earlier on a tie.
  static void winner(const ColumnSums& sums, int column0, int row, int first_d, int begin, int end, int& best_cost, int& best_d) {
    const Sums16 d16;
    begin = std::max(begin, 0);
    end = std::min(end, kLanes);
    if (begin >= end) return;
    const auto first = hn::Set(d16, static_cast<std::uint16_t>(begin)), last = hn::Set(d16, static_cast<std::uint16_t>(end - 1));
    const int n = static_cast<int>(hn::Lanes(d16));
    for (int lane = 0; lane < kLanes; lane += n) {
      auto sum = hn::Load(d16, sums.sum[column0][row] + lane);
      for (int c = 1; c < 7; ++c) sum = hn::Add(sum, hn::Load(d16, sums.sum[column0 + c][row] + lane));
      const auto index = hn::Iota(d16, static_cast<std::uint16_t>(lane));
      // Lanes outside [begin, end) lose: |index - clamp(index)| is not 0 there.
      const auto clamped = hn::Min(hn::Max(index, first), last);
      sum = hn::IfThenElse(hn::Eq(index, clamped), sum, hn::Set(d16, 0xFFFF));
      const int least = hn::GetLane(hn::MinOfLanes(d16, sum));
      if (least >= best_cost) continue;
      best_cost = least;
      best_d = first_d + lane + static_cast<int>(hn::FindFirstTrue(d16, hn::Eq(sum, hn::Set(d16, static_cast<std::uint16_t>(least)))));
    }
  }
};

template <bool kMasked>
void match_row_pair(const MatchAround& in, const simd::MatchAroundScratch& scratch, View<std::int16_t> dst, int y0) {
  const int w = dst.width(), h = dst.height();
  const bool whole_row = in.coarser.empty();
  const Block<kMasked> block(in, scratch, y0);
  ColumnSums ring[2];  // the block before and this one
  int now = 0, base_before = std::numeric_limits<int>::min();
  for (int x0 = 0; x0 < w; x0 += 2, now ^= 1) {
    int best_cost[4], best_d[4] = {};
    std::fill_n(best_cost, 4, std::numeric_limits<int>::max());
    ColumnSums& sums = ring[now];
    // The four windows of the block; the lowest level tries d = x - (w-1) .. x, one step more for the odd column.
    const auto winners = [&](int first_d, int begin, int end, int shift) {
      for (int i = 0; i < 4; ++i)
        Block<kMasked>::winner(sums, i & 1, i >> 1, first_d, begin + shift * (i & 1), end + shift * (i & 1), best_cost[i], best_d[i]);
    };
    if (whole_row) {
      const int first = x0 - (w - 1);
      for (int k = 0; k <= w; k += kLanes) {
        for (int c = 0; c < kColumns; ++c) block.column(x0 - 3 + c, first + k, sums.sum[c]);
        winners(first + k, -k, w - k, 1);
      }
    } else {
      const int base = 2 * in.coarser.at(y0 / 2, x0 / 2);
      int c = 0;
      if (base == base_before)
        for (; c < kColumns - 2; ++c) std::copy_n(&ring[now ^ 1].sum[c + 2][0][0], 2 * kLanes, &sums.sum[c][0][0]);
      for (; c < kColumns; ++c) block.column(x0 - 3 + c, base - in.radius, sums.sum[c]);
      winners(base - in.radius, 0, 2 * in.radius + 1, 0);
      base_before = base;
    }
    for (int i = 0; i < 4; ++i)
      if (y0 + (i >> 1) < h && x0 + (i & 1) < w) dst.at(y0 + (i >> 1), x0 + (i & 1)) = static_cast<std::int16_t>(best_d[i]);
  }
}

void match_rows(const MatchAround& in, const simd::MatchAroundScratch& scratch, View<std::int16_t> dst, int y_begin, int y_end) {
  for (int y = y_begin; y < y_end; y += 2)
    if (in.left_inside.empty())
      match_row_pair<false>(in, scratch, dst, y);
    else
      match_row_pair<true>(in, scratch, dst, y);
}

}  // namespace duo::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace duo {
HWY_EXPORT(match_rows);

namespace simd {
namespace {

void mirror_rows(const MatchAround& in, MatchAroundScratch& s, int y_begin, int y_end) {
  constexpr int kPad = MatchAroundScratch::kPad;
  const int w = in.right.width();
  for (int y = y_begin; y < y_end; ++y) {
    const std::uint8_t* right = in.right.row(y);
    std::uint8_t *r = s.right.row(y), *half = s.half.row(y);
    for (int x = 0; x < w; ++x) r[kPad + w - 1 - x] = right[x];
    std::fill_n(r, kPad, right[w - 1]);
    std::fill_n(r + kPad + w, kPad, right[0]);
    // half[i] lies between the pixel of r[i] and its left neighbour, r[i + 1].
    const int last = w + 2 * kPad - 1;
    for (int i = 0; i < last; ++i) half[i] = static_cast<std::uint8_t>((r[i] + r[i + 1] + 1) / 2);
    half[last] = r[last];
    if (in.right_inside.empty()) continue;
    const std::uint8_t* inside = in.right_inside.row(y);
    std::uint8_t* outside = s.outside.row(y);
    for (int x = 0; x < w; ++x) outside[kPad + w - 1 - x] = static_cast<std::uint8_t>(~inside[x]);
    std::fill_n(outside, kPad, static_cast<std::uint8_t>(~inside[w - 1]));
    std::fill_n(outside + kPad + w, kPad, static_cast<std::uint8_t>(~inside[0]));
  }
}

}  // namespace

void match_around(Pool& pool, const MatchAround& in, MatchAroundScratch& scratch, View<std::int16_t> dst) {
  DUO_CHECK(in.left.size() == in.right.size() && in.left.size() == dst.size());
  DUO_CHECK(in.coarser.empty() || in.radius <= 15);
  DUO_CHECK(scratch.right.size() == MatchAroundScratch::size_for(dst.size()));
  pool.rows(dst.height(), [&](int begin, int end) { mirror_rows(in, scratch, begin, end); });
  const auto rows = HWY_DYNAMIC_DISPATCH(match_rows);
  pool.rows(dst.height(), [&](int begin, int end) { rows(in, scratch, dst, begin, end); }, 2);
}

}  // namespace simd
}  // namespace duo
#endif
