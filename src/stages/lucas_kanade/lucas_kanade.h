// The last fraction of a pixel by gray gradients: what paths have flattened becomes round again.
#pragma once

#include <cstdint>
#include <vector>

#include "core/pool.h"
#include "core/row_band.h"
#include "duoptic/frame.h"

namespace duo {

/// One step of least squares towards the disparity at which both views' gray values are alike.
///
/// Tap: a pixel in an even row with a disparity, whose two neighbours in the row are in the picture, as are, in the right view,
/// the two pixels that its place x - d lies between and one more on either side. e: left value minus the right one at that
/// place, linear between its pixels. g: mean of both views' central differences there, the right view's linear between pixels,
/// too. A tap with |e| >= kMostDifference does not count: it sees something else. Over the taps in the columns x +- kRadius and
/// the rows y +- kRadius, of an odd y those of the row above, each at its own disparity, so that a slant changes nothing:
/// step = -1.5 sum(e g w) / sum(g^2 w + 1/20), rounded to 1/16 px and held to +-kMost_q4; the result is held to
/// 0 .. max_disparity - 1. w = 1 / (g^2 + 4): paths flatten where there is little to see, and there gradients of shading must
/// not be outvoted by a few strong ones, whose disparities are right already. These still hold the others back, hence 1.5.
/// Where there is no gradient nothing changes.
///
/// Shape    all H x W; dst is not the same memory as d_q4
/// Units    d_q4 1/16 px, Disparity::kNone = hole, which stays one; e in gray levels, g in those per px
/// Threads  pairs of rows are independent
/// Exact    ref, simd and vk agree bit for bit: integers, e in 1/16, g in 1/4; what a tap adds is rounded once, see below; sums
///          stay below 2^26
/// Source   Lucas, Kanade, "An iterative image registration technique with an application to stereo vision", 1981; 1.5 as
///          in Young, "Iterative methods for solving partial difference equations of elliptic type", 1954 (over-relaxation);
///          taps at disparities of their own, in every second row, are ours
struct LucasKanade {
  static constexpr int kRadius = 12, kMostDifference = 8, kMost_q4 = 8;
  static constexpr int kRows = kRadius + 1;  // what a row depends on, up and down
  static constexpr int kMostGradient_q2 = 510;

  View<const std::uint8_t> left, right;
  View<const std::uint16_t> d_q4;
  int max_disparity = 0;
  RowBand rows = {};  // of dst that are needed; others may hold anything
};

/// g w in 1/2^14, of g >= 0 in 1/4: at most 256, so that with e of 1/16 a tap fits 16 bits.
constexpr int lucas_kanade_pull(int g_q2) {
  const int most = g_q2 * g_q2 + 64;
  return (4096 * g_q2 + most / 2) / most;
}
/// g^2 w + 1/20 in 2/3 of 1/1024: so the quotient of the sums is one and a half steps in 1/16 px.
constexpr int lucas_kanade_weight(int g_q2) {
  const int square = g_q2 * g_q2, most = square + 64;
  return (683 * square + most / 2) / most + 34;
}

/// What a tap adds to the sums, and these themselves: of e g w, and of g^2 w + 1/20.
struct LucasKanadeSums {
  int pull = 0, weight = 0;
  void add(const LucasKanadeSums& tap) { pull += tap.pull, weight += tap.weight; }
  int step_q4() const;
};

namespace ref {
LucasKanadeSums lucas_kanade_tap(const LucasKanade& in, int y, int x);
void lucas_kanade(const LucasKanade& in, View<std::uint16_t> dst);
}  // namespace ref

namespace simd {
struct LucasKanadeScratch {
  LucasKanadeScratch(Size size, int threads);

  static constexpr int kRows = LucasKanade::kRadius + 1, kBefore = 32;  // of taps in use; columns around a row
  struct Thread {
    Image<std::int16_t> pull, weight;  // of taps: [row / 2 % kRows]
    Image<std::int32_t> sums;          // of both over the rows of the window; and last the steps of a pair of rows
  };
  std::vector<Thread> threads;
};
void lucas_kanade(Pool& pool, const LucasKanade& in, LucasKanadeScratch& scratch, View<std::uint16_t> dst);
}  // namespace simd

}  // namespace duo
