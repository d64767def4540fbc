// Weighted median of disparities: each pixel takes the middle of the values around it that lie on its own surface.
#pragma once

#include <array>
#include <cstdint>

#include "core/pool.h"
#include "core/row_band.h"
#include "duoptic/frame.h"

namespace duo {

/// Weighted median of 7x7 pixels, every second one of a 13x13 window; pixels of like gray value weigh more.
///
/// Taps: the pixels at offsets {-6, -4, -2, 0, 2, 4, 6} in x and y that lie in the picture and have a disparity. A tap's weight
/// is kWeights[|guide(tap) - guide(centre)| / 4], 0 for differences of 64 and more. Result: the smallest tap value v for which
/// the taps with values <= v have at least half the weight of all. Holes are copied.
///
/// Shape    all H x W; dst is not the same memory as d_q4
/// Units    d_q4 any value, Disparity::kNone = hole; guide gray values
/// Border   taps outside the picture do not count
/// Threads  rows are independent
/// Exact    ref, simd and vk agree bit for bit; weights sum to 49 * 57 = 2793 at most
/// Source   Ma, He, Wei, Sun, Wu, "Constant time weighted median filtering for stereo matching and beyond", 2013 (a guided
/// median
///          as the last step of stereo); the sparse window and whole-numbered weights are ours: 49 taps instead of 169 cost
///          0.1 points of accuracy
struct WeightedMedian {
  /// round(64 exp(-(4 i + 1.5) / 14)): 4 i + 1.5 is the mean of the differences that share an entry.
  alignas(16) static constexpr std::array<std::uint8_t, 16> kWeights = {57, 43, 32, 24, 18, 14, 10, 8, 6, 4, 3, 2, 2, 1, 1, 1};
  static constexpr int kRadius = 6, kStep = 2;

  View<const std::uint16_t> d_q4;
  View<const std::uint8_t> guide;
  RowBand rows = {};  // of dst that are needed; others may hold anything
};

namespace ref {
void weighted_median(const WeightedMedian& in, View<std::uint16_t> dst);
}

namespace simd {
/// The inputs once more, with columns around them so that taps outside the picture can be read.
class WeightedMedianScratch {
 public:
  /// For pictures of this size, and smaller ones.
  explicit WeightedMedianScratch(Size size);

  Size most, size;             // of all pictures, of the last one
  Image<std::int16_t> values;  // d_q4 - 2^15: the order of unsigned values in signed lanes
  Image<std::int16_t> guide;   // with kNowhere added where there is no disparity
};
void weighted_median(Pool& pool, const WeightedMedian& in, WeightedMedianScratch& scratch, View<std::uint16_t> dst);
}  // namespace simd

}  // namespace duo
