// Brightness of the right picture brought to the left one's: two webcams never agree on exposure and gain.
#pragma once

#include <array>
#include <cstdint>

#include "core/gray_pair.h"
#include "core/pool.h"

namespace duo {

/// dst = right picture under the one gain and offset that give it the mean and the standard deviation of the left picture; only
/// pixels inside their raw pictures are counted. A flat picture on either side is only shifted.
///
/// Shape    pair H x W, dst the same
/// Threads  rows are independent once the sums are there
/// Exact    ref, simd and vk agree bit for bit: integer sums, then one table of 256 values in integers. Deviations in 1/2^24,
/// rounded
///          down; means, gain and offset in 1/2^16, rounded to the nearest; for up to 2^23 pixels
/// Source   the affine brightness model of Hirschmueller, Scharstein, "Evaluation of stereo matching costs on images with
/// radiometric
///          differences", 2009, solved from the two first moments
namespace ref {
void balance(const GrayPair& pair, View<std::uint8_t> dst);
}
namespace simd {
void balance(Pool& pool, const GrayPair& pair, View<std::uint8_t> dst);
}

/// Count, sum and sum of squares of the inside pixels of one picture.
struct BrightnessSums {
  std::int64_t count = 0, sum = 0, squares = 0;
  void add(const BrightnessSums& other) { count += other.count, sum += other.sum, squares += other.squares; }
};
BrightnessSums brightness_sums(View<const std::uint8_t> picture, View<const std::uint8_t> inside, int y_begin, int y_end);

/// What each value of the right picture becomes.
std::array<std::uint8_t, 256> balance_table(const BrightnessSums& left, const BrightnessSums& right);

}  // namespace duo
