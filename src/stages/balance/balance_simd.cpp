#include <algorithm>
#include <mutex>

#include "core/check.h"
#include "stages/balance/balance.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "stages/balance/balance_simd.cpp"
#include <hwy/foreach_target.h>
// After foreach_target.h, as Highway asks.
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace duo::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// Sums of 8x8 pixels and whether all of these are inside, of one row of cells.
void sum_cells(View<const std::uint8_t> picture, View<const std::uint8_t> inside, int row, int cells,
               std::uint8_t* HWY_RESTRICT mean, std::uint8_t* HWY_RESTRICT outside) {
  constexpr int kCell = kBalanceCell, kRun = 64, kPixels = kCell * kCell;
  for (int first = 0; first < cells; first += kRun) {
    const int count = std::min(kRun, cells - first), columns = count * kCell;
    std::uint16_t sums[kRun * kCell] = {};
    std::uint8_t none[kRun * kCell] = {};
    for (int y = row * kCell; y < (row + 1) * kCell; ++y) {
      const std::uint8_t* src = picture.row(y) + first * kCell;
      for (int x = 0; x < columns; ++x) sums[x] = static_cast<std::uint16_t>(sums[x] + src[x]);
      if (inside.empty()) continue;
      const std::uint8_t* mask = inside.row(y) + first * kCell;
      for (int x = 0; x < columns; ++x) none[x] |= mask[x] == 0 ? 1 : 0;
    }
    for (int i = 0; i < count; ++i) {
      int sum = kPixels / 2, any = 0;
      for (int x = i * kCell; x < (i + 1) * kCell; ++x) sum += sums[x], any |= none[x];
      mean[first + i] = static_cast<std::uint8_t>(sum / kPixels);
      outside[first + i] = any != 0 ? 255 : 0;
    }
  }
}

/// The census of one row of cells from the rows of means and of what is outside around it, whose first columns lie
/// kBalanceReach cells before those of the census. Works on whole vectors: all rows are kPadding longer.
void census_of_row(const std::uint8_t* const* means, const std::uint8_t* const* outside, int w, std::uint8_t* const census[3],
                   std::uint8_t* census_outside) {
  const hn::ScalableTag<std::uint8_t> d;
  constexpr int kAcross = 2 * kBalanceReach + 1;
  for (int x = 0; x < w; x += static_cast<int>(hn::Lanes(d))) {
    const std::uint8_t* around[kBalanceAround] = {};
    auto any = hn::Zero(d);
    for (int y = 0, count = 0; y < kAcross; ++y)
      for (int i = 0; i < kAcross; ++i) {
        any = hn::Or(any, hn::LoadU(d, outside[y] + x + i));
        if (y != kBalanceReach || i != kBalanceReach) around[count++] = means[y] + x + i;
      }
    hn::StoreU(any, d, census_outside + x);
    for (int byte = 0; byte < 3; ++byte) {
      auto bits = hn::Zero(d);
      for (int bit = 0; bit < 8; ++bit) {
        const int i = 8 * byte + bit, other = (i + kBalanceApart) % kBalanceAround;
        const auto darker = hn::Lt(hn::LoadU(d, around[i]), hn::LoadU(d, around[other]));
        bits = hn::Or(bits, hn::IfThenElseZero(darker, hn::Set(d, static_cast<std::uint8_t>(1 << bit))));
      }
      hn::StoreU(bits, d, census[byte] + x);
    }
  }
}

/// Compares w left cells with as many right ones, `disparity` cells apart; `left` and `right`: the census and where it is
/// outside. Works on whole vectors: what lies behind a row is outside.
void compare_cells(const std::uint8_t* const left[4], const std::uint8_t* const right[4], int w, int disparity,
                   std::uint8_t* left_difference, std::uint8_t* left_disparity, std::uint8_t* right_difference,
                   std::uint8_t* right_disparity) {
  const hn::ScalableTag<std::uint8_t> d;
  const auto nearer = hn::Set(d, static_cast<std::uint8_t>(disparity));
  for (int x = 0; x < w; x += static_cast<int>(hn::Lanes(d))) {
    auto difference = hn::Or(hn::LoadU(d, left[3] + x), hn::LoadU(d, right[3] + x));
    for (int byte = 0; byte < 3; ++byte)
      difference = hn::SaturatedAdd(difference,
                                    hn::PopulationCount(hn::Xor(hn::LoadU(d, left[byte] + x), hn::LoadU(d, right[byte] + x))));
    const auto keep = [&](std::uint8_t* least, std::uint8_t* where) HWY_ATTR {
      const auto before = hn::LoadU(d, least + x);
      hn::StoreU(hn::IfThenElse(hn::Lt(difference, before), nearer, hn::LoadU(d, where + x)), d, where + x);
      hn::StoreU(hn::Min(difference, before), d, least + x);
    };
    keep(left_difference, left_disparity);
    keep(right_difference, right_disparity);
  }
}

/// The whole vectors of a row looked up in 256 values; returns how many pixels these are. Sixteen tables of sixteen: each gives
/// 0 for a value that is not its own.
int look_up_row(const std::uint8_t* src, const std::uint8_t* table, int w, std::uint8_t* dst) {
  const hn::ScalableTag<std::uint8_t> d;
  const int n = static_cast<int>(hn::Lanes(d));
  int x = 0;
  for (; x + n <= w; x += n) {
    const auto v = hn::LoadU(d, src + x);
    auto found = hn::Zero(d);
    for (int part = 0; part < 16; ++part) {
      // 0 .. 15 become 0x70 .. 0x7F, all else 0x80 and more: the high bit asks for 0, the low ones are the index.
      const auto raised = hn::SaturatedAdd(hn::Sub(v, hn::Set(d, static_cast<std::uint8_t>(16 * part))), hn::Set(d, 0x70));
      const auto index = hn::And(raised, hn::Set(d, 0x8F));
      found = hn::Or(found, hn::TableLookupBytesOr0(hn::LoadDup128(d, table + 16 * part), index));
    }
    hn::StoreU(found, d, dst + x);
  }
  return x;
}

}  // namespace duo::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace duo {
HWY_EXPORT(sum_cells);
HWY_EXPORT(census_of_row);
HWY_EXPORT(compare_cells);
HWY_EXPORT(look_up_row);

BalanceScratch::BalanceScratch(Size picture) : cells{picture.width / kBalanceCell, picture.height / kBalanceCell} {
  if (cells.empty()) {
    cells = {};
    return;
  }
  for (Cells* view : {&left, &right}) {
    const Size padded{cells.width + kPadding, cells.height}, around{padded.width + 2 * kBalanceReach, cells.height};
    for (auto* image : {&view->mean, &view->outside}) *image = Image<std::uint8_t>(around);
    for (auto* image : {&view->census[0], &view->census[1], &view->census[2], &view->difference, &view->disparity})
      *image = Image<std::uint8_t>(padded);
    view->census_outside = Image<std::uint8_t>(padded);
    // What is never written: around the picture and behind it.
    for (int y = 0; y < cells.height; ++y) {
      std::fill_n(view->mean.row(y), around.width, std::uint8_t{0});
      std::fill_n(view->outside.row(y), around.width, std::uint8_t{255});
      std::fill_n(view->difference.row(y), padded.width, std::uint8_t{255});
      std::fill_n(view->census_outside.row(y), padded.width, std::uint8_t{255});
      for (auto* image : {&view->census[0], &view->census[1], &view->census[2], &view->disparity})
        std::fill_n(image->row(y), padded.width, std::uint8_t{0});
    }
  }
}

namespace simd {
namespace {

void make_cells(View<const std::uint8_t> picture, View<const std::uint8_t> inside, int row, int w, BalanceScratch::Cells& out) {
  HWY_DYNAMIC_DISPATCH(sum_cells)
  (picture, inside, row, w, out.mean.row(row) + kBalanceReach, out.outside.row(row) + kBalanceReach);
}

/// Rows at the edges have none: they stay outside.
void make_census(int row, Size size, BalanceScratch::Cells& cells) {
  if (row < kBalanceReach || row >= size.height - kBalanceReach) return;
  const std::uint8_t *means[2 * kBalanceReach + 1] = {}, *outside[2 * kBalanceReach + 1] = {};
  for (int i = 0; i <= 2 * kBalanceReach; ++i)
    means[i] = cells.mean.row(row + i - kBalanceReach), outside[i] = cells.outside.row(row + i - kBalanceReach);
  std::uint8_t* const census[3] = {cells.census[0].row(row), cells.census[1].row(row), cells.census[2].row(row)};
  HWY_DYNAMIC_DISPATCH(census_of_row)(means, outside, size.width, census, cells.census_outside.row(row));
}

void add_pairs(int row, int max_disparity, BalanceScratch& scratch, BrightnessPair& sums) {
  BalanceScratch::Cells &left = scratch.left, &right = scratch.right;
  const int w = scratch.cells.width, most = std::min(most_cells_apart(max_disparity), w - 1);
  for (auto* cells : {&left, &right}) std::fill_n(cells->difference.row(row), w, std::uint8_t{255});
  for (int d = 0; d <= most; ++d) {
    const std::uint8_t *l[4] = {}, *r[4] = {};
    for (std::size_t i = 0; i < 3; ++i) l[i] = left.census[i].row(row) + d, r[i] = right.census[i].row(row);
    l[3] = left.census_outside.row(row) + d, r[3] = right.census_outside.row(row);
    HWY_DYNAMIC_DISPATCH(compare_cells)
    (l, r, w - d, d, left.difference.row(row) + d, left.disparity.row(row) + d, right.difference.row(row),
     right.disparity.row(row));
  }
  for (int x = 0; x < w; ++x) {
    if (left.difference.at(row, x) > kBalanceAlike) continue;
    const int d = left.disparity.at(row, x);
    if (right.disparity.at(row, x - d) != d) continue;
    sums.add(left.mean.at(row, kBalanceReach + x), right.mean.at(row, kBalanceReach + x - d));
  }
}

}  // namespace

// The order in which parts are added does not change integer sums.
void balance(Pool& pool, const GrayPair& pair, int max_disparity, int unbalanced, BalanceScratch& scratch,
             View<std::uint8_t> dst) {
  DUO_CHECK(pair.right.size() == dst.size() && max_disparity >= 1);
  const Size cells = scratch.cells;
  DUO_CHECK(cells.empty() || cells == (Size{dst.width() / kBalanceCell, dst.height() / kBalanceCell}));
  pool.rows(cells.height, [&](int begin, int end) {
    for (int row = begin; row < end; ++row) {
      make_cells(pair.left, pair.left_inside, row, cells.width, scratch.left);
      make_cells(pair.right, pair.right_inside, row, cells.width, scratch.right);
    }
  });
  BrightnessPair all;
  std::mutex mutex;
  pool.rows(cells.height, [&](int begin, int end) {
    BrightnessPair sums;
    for (int row = begin; row < end; ++row) {
      make_census(row, cells, scratch.left);
      make_census(row, cells, scratch.right);
      add_pairs(row, max_disparity, scratch, sums);
    }
    const std::lock_guard lock(mutex);
    all.add(sums);
  });
  alignas(16) const auto table = balance_table(all, unbalanced);
  pool.rows(dst.height(), [&](int begin, int end) {
    for (int y = begin; y < end; ++y) {
      const std::uint8_t* src = pair.right.row(y);
      int x = HWY_DYNAMIC_DISPATCH(look_up_row)(src, table.data(), dst.width(), dst.row(y));
      for (; x < dst.width(); ++x) dst.row(y)[x] = table[src[x]];
    }
  });
}

}  // namespace simd
}  // namespace duo
#endif
