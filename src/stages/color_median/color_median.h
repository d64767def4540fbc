// Weighted median of disparities by colour: each pixel takes the middle of the values around it that lie on its own surface.
#pragma once

#include <array>
#include <cstdint>

#include "core/pool.h"
#include "duoptic/frame.h"

namespace duo {

/// As the weighted median by gray values (stages/weighted_median), but by colours, in a window of any size, and only where it
/// is asked for. Colours tell surfaces apart that are equally bright.
///
/// Taps: the pixels at offsets -radius, -radius + 2 .. radius in x and y that lie in the picture and have a disparity. A tap's
/// weight is kWeights[step / 4] of the sum of the three colours' steps, 0 for steps of 64 and more. Result: the smallest tap
/// value v for which the taps with values <= v have at least half the weight of all. Holes are copied, and so is what is not
/// chosen. Where pixels are chosen, they are those that were filled, and this is a vote: a tap's weight is times
/// 64 kHalf_px2 / (kHalf_px2 + r^2), rounded down, at a distance of r px, and a kChosenCount-th of that, rounded down, of one that
/// is chosen itself: guesses are not to agree with each other against what was measured.
///
/// Shape    all H x W; chosen may be empty = all pixels; dst is not the same memory as d_q4
/// Units    d_q4 any value, Disparity::kNone = hole; radius even, 2 .. 12 px; chosen 0 or not
/// Threads  rows are independent; simd runs the plain loops on all threads, as it is for matchers that need not be fast
/// Exact    integers
/// Source   Ma, He, Wei, Sun, Wu, "Constant time weighted median filtering for stereo matching and beyond", 2013
struct ColorMedian {
  /// round(255 exp(-(4 i + 1.5) / 10)), at least 1.
  static constexpr std::array<std::uint8_t, 16> kWeights = {219, 147, 99, 66, 44, 30, 20, 13, 9, 6, 4, 3, 2, 1, 1, 1};
  static constexpr int kStep = 2, kMostRadius = 12;
  static constexpr int kHalf_px2 = 40, kChosenCount = 4;

  View<const std::uint16_t> d_q4;
  View<const Rgb8> guide;
  View<const std::uint8_t> chosen = {};
  int radius = 6;
};

namespace ref {
void color_median(const ColorMedian& in, View<std::uint16_t> dst);
}
namespace simd {
void color_median(Pool& pool, const ColorMedian& in, View<std::uint16_t> dst);
}

}  // namespace duo
