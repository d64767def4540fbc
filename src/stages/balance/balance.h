// Brightness of the right picture brought to the left one's: two webcams never agree on exposure and gain.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>

#include "core/pool.h"
#include "stages/balance/balance_params.h"
#include "stages/types/gray_pair.h"

namespace duo {

/// dst = right picture under the one gain and offset that give what both views see the same mean and standard deviation in
/// both.
///
/// What both see: cells of 8x8 pixels, each the mean of its pixels, rounded. A cell's census tells of the 24 cells around it,
/// counted row by row, whether each is darker than the one seven further (after the last comes the first): so whatever gain
/// and offset the picture has, and more than whether the cell is the darkest around. Left cell x and right cell x - d,
/// d = 0 .. ceil(max_disparity / 8), differ by as much as bits of their census, and see the same where these are at most
/// kBalanceAlike and each is the other's nearest, the smallest d of equals. Only cells whose census lies inside the picture and
/// the raw one take part, and pairs count of which neither is darker than kBalanceDark or brighter than kBalanceBright, where
/// cameras cut off. With fewer than kBalanceFewest such pairs dst = right; where either side of them is flat they are only
/// shifted. Where no value of 0 .. 255 would change by more than `unbalanced`, dst = right: the balance itself may be wrong by
/// as much, and its rounding takes small gradients away.
///
/// Shape    pair H x W, dst the same; cells H / 8 x W / 8, whole ones
/// Units    max_disparity px, from 1 on; unbalanced gray levels, 0: every change is made
/// Border   two cells along each edge have no census
/// Threads  rows of cells are independent, then those of the picture
/// Exact    ref, simd and vk agree bit for bit: integer sums, then one table of 256 values in integers. Deviations in 1/2^24,
///          rounded down; means, gain and offset in 1/2^16, rounded to the nearest; for up to 2^23 cells
/// Source   the affine brightness model of Hirschmueller, Scharstein, "Evaluation of stereo matching costs on images with
///          radiometric differences", 2009, solved from the two first moments. Moments of whole pictures mislead where one view
///          sees what the other does not: a person near the cameras, a lens whose correction leaves less of one picture
namespace ref {
void balance(const GrayPair& pair, int max_disparity, int unbalanced, View<std::uint8_t> dst);
}
class BalanceScratch;
namespace simd {
void balance(Pool& pool, const GrayPair& pair, int max_disparity, int unbalanced, BalanceScratch& scratch,
             View<std::uint8_t> dst);
}

/// Both views in cells, and how much each one's nearest in the other view differs and how far away it is.
class BalanceScratch {
 public:
  explicit BalanceScratch(Size picture);

  static constexpr int kPadding = 64;  // columns behind each row, which whole vectors run into
  struct Cells {
    Image<std::uint8_t> mean, outside;  // [row][kBalanceReach + x]; outside: 255 where not all its pixels are inside, or 0
    std::array<Image<std::uint8_t>, 3> census;  // [row][x], eight bits each
    Image<std::uint8_t> census_outside;         // [row][x], 255 or 0
    Image<std::uint8_t> difference, disparity;  // [row][x], of the nearest; difference 255: none
  };
  Size cells;
  Cells left, right;
};

/// Count, sum and sum of squares of the cells of one view.
struct BrightnessSums {
  std::int64_t count = 0, sum = 0, squares = 0;
  void add(std::int64_t value) { ++count, sum += value, squares += value * value; }
  void add(const BrightnessSums& other) { count += other.count, sum += other.sum, squares += other.squares; }
};
/// Of the cells that see the same: equal counts.
struct BrightnessPair {
  BrightnessSums left, right;
  /// A pair of cells, if it counts.
  void add(int left_mean, int right_mean) {
    if (std::min(left_mean, right_mean) < kBalanceDark || std::max(left_mean, right_mean) > kBalanceBright) return;
    left.add(left_mean), right.add(right_mean);
  }
  void add(const BrightnessPair& other) { left.add(other.left), right.add(other.right); }
};

/// The largest disparity that is looked for, in cells.
inline int most_cells_apart(int max_disparity) {
  return std::min((max_disparity + kBalanceCell - 1) / kBalanceCell, kBalanceMost);
}

/// What each value of the right picture becomes.
std::array<std::uint8_t, 256> balance_table(const BrightnessPair& sums, int unbalanced);

}  // namespace duo
