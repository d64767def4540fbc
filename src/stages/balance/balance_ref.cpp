#include <algorithm>
#include <bit>
#include <cstdlib>
#include <numeric>
#include <vector>

#include "core/check.h"
#include "stages/balance/balance.h"

namespace duo {
namespace {

/// The whole part of the square root, bit by bit.
std::uint64_t whole_root(std::uint64_t v) {
  std::uint64_t root = 0;
  for (int bit = 30; bit >= 0; --bit) {
    const std::uint64_t longer = root | std::uint64_t{1} << bit;
    if (longer * longer <= v) root = longer;
  }
  return root;
}

/// Standard deviation, rounded down; below 2^31. With up to 2^23 cells count^2 V = count squares - sum^2 is below 2^60 and
/// count^2 at most 2^46, so each step of the long division, 16 bits of the fraction, stays below 2^62.
std::uint64_t deviation_q24(const BrightnessSums& s) {
  const auto square = static_cast<std::uint64_t>(s.count * s.count);
  auto rest = static_cast<std::uint64_t>(s.squares * s.count - s.sum * s.sum);
  std::uint64_t variance_q48 = rest / square;  // below 2^14
  for (int step = 0; step < 3; ++step) {
    rest = rest % square << 16;
    variance_q48 = variance_q48 << 16 | rest / square;
  }
  return whole_root(variance_q48);
}

std::int64_t mean_q16(const BrightnessSums& s) { return ((s.sum << 16) + s.count / 2) / s.count; }

}  // namespace

std::array<std::uint8_t, 256> balance_table(const BrightnessPair& sums, int unbalanced) {
  const BrightnessSums &left = sums.left, &right = sums.right;
  std::int64_t gain_q16 = 1 << 16, offset_q16 = 0;
  if (left.count >= kBalanceFewest) {
    const std::uint64_t from = deviation_q24(right), to = deviation_q24(left);
    // One cell of 2^23 that differs gives a deviation of 2^-12: the gain is below 2^19, and its products below 2^59.
    if (from > 0 && to > 0) gain_q16 = static_cast<std::int64_t>(((to << 16) + from / 2) / from);
    offset_q16 = mean_q16(left) - ((gain_q16 * mean_q16(right) + (1 << 15)) >> 16);
  }
  std::array<std::uint8_t, 256> table{};
  for (int v = 0; v < 256; ++v)
    table[static_cast<std::size_t>(v)] =
        static_cast<std::uint8_t>(std::clamp<std::int64_t>((gain_q16 * v + offset_q16 + (1 << 15)) >> 16, 0, 255));
  int most = 0;
  for (int v = 0; v < 256; ++v) most = std::max(most, std::abs(table[static_cast<std::size_t>(v)] - v));
  if (most <= unbalanced) std::iota(table.begin(), table.end(), std::uint8_t{0});
  return table;
}

namespace ref {
namespace {

struct Cell {
  int mean = 0;
  bool inside = true;
  std::uint32_t census = 0;
  bool census_inside = true;
};
/// [row][x].
using Cells = std::vector<std::vector<Cell>>;

Cell cell(View<const std::uint8_t> picture, View<const std::uint8_t> inside, int row, int x) {
  constexpr int kPixels = kBalanceCell * kBalanceCell;
  Cell out;
  int sum = 0;
  for (int py = row * kBalanceCell; py < (row + 1) * kBalanceCell; ++py)
    for (int px = x * kBalanceCell; px < (x + 1) * kBalanceCell; ++px) {
      sum += picture.at(py, px);
      if (!inside.empty() && inside.at(py, px) == 0) out.inside = false;
    }
  out.mean = (sum + kPixels / 2) / kPixels;
  return out;
}

void add_census(Cells& cells, int row, int x) {
  const int h = static_cast<int>(cells.size()), w = static_cast<int>(cells[0].size());
  Cell& here = cells[static_cast<std::size_t>(row)][static_cast<std::size_t>(x)];
  std::vector<int> around;
  for (int ny = row - kBalanceReach; ny <= row + kBalanceReach; ++ny)
    for (int nx = x - kBalanceReach; nx <= x + kBalanceReach; ++nx) {
      if (ny < 0 || ny >= h || nx < 0 || nx >= w) {
        here.census_inside = false;
        return;
      }
      const Cell& there = cells[static_cast<std::size_t>(ny)][static_cast<std::size_t>(nx)];
      here.census_inside &= there.inside;
      if (ny != row || nx != x) around.push_back(there.mean);
    }
  for (std::size_t i = 0; i < kBalanceAround; ++i)
    here.census |= static_cast<std::uint32_t>(around[i] < around[(i + kBalanceApart) % kBalanceAround]) << i;
}

Cells cells_of(View<const std::uint8_t> picture, View<const std::uint8_t> inside) {
  const int h = picture.height() / kBalanceCell, w = picture.width() / kBalanceCell;
  Cells out(static_cast<std::size_t>(w > 0 ? h : 0));
  for (int row = 0; row < static_cast<int>(out.size()); ++row)
    for (int x = 0; x < w; ++x) out[static_cast<std::size_t>(row)].push_back(cell(picture, inside, row, x));
  for (int row = 0; row < static_cast<int>(out.size()); ++row)
    for (int x = 0; x < w; ++x) add_census(out, row, x);
  return out;
}

/// Column of the cell in the other view, `sign` d cells away, that is nearest to cell x; -1 = none is alike.
int nearest(const std::vector<Cell>& row, int x, const std::vector<Cell>& other, int sign, int most) {
  const Cell& here = row[static_cast<std::size_t>(x)];
  int best = -1, least = kBalanceAlike + 1;
  for (int d = 0; d <= most; ++d) {
    const int there = x + sign * d;
    if (there < 0 || there >= static_cast<int>(other.size())) break;
    const Cell& cell = other[static_cast<std::size_t>(there)];
    if (!here.census_inside || !cell.census_inside) continue;
    const int difference = std::popcount(here.census ^ cell.census);
    if (difference < least) best = there, least = difference;
  }
  return best;
}

}  // namespace

void balance(const GrayPair& pair, int max_disparity, int unbalanced, View<std::uint8_t> dst) {
  DUO_CHECK(pair.right.size() == dst.size() && max_disparity >= 1);
  const Cells left = cells_of(pair.left, pair.left_inside), right = cells_of(pair.right, pair.right_inside);
  const int most = most_cells_apart(max_disparity);
  BrightnessPair sums;
  for (std::size_t row = 0; row < left.size(); ++row)
    for (int x = 0; x < static_cast<int>(left[row].size()); ++x) {
      const int there = nearest(left[row], x, right[row], -1, most);
      if (there < 0 || nearest(right[row], there, left[row], 1, most) != x) continue;
      sums.add(left[row][static_cast<std::size_t>(x)].mean, right[row][static_cast<std::size_t>(there)].mean);
    }
  const auto table = balance_table(sums, unbalanced);
  for (int y = 0; y < dst.height(); ++y)
    for (int x = 0; x < dst.width(); ++x) dst.at(y, x) = table[pair.right.at(y, x)];
}

}  // namespace ref
}  // namespace duo
