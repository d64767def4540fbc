// The last fraction of a pixel by gray gradients: what paths have flattened becomes round again.
#pragma once

#include <cstdint>
#include <vector>

#include "core/pool.h"
#include "core/row_band.h"
#include "duoptic/frame.h"
#include "stages/lucas_kanade/lucas_kanade_params.h"

namespace duo {

/// One step of least squares towards the disparity at which both views' gray values are alike.
///
/// Tap: a pixel of even row and column with a disparity, whose two neighbours in the row are in the picture, as are, in the
/// right view, the two pixels that its place x - d lies between and one more on either side. e: left value minus the right one
/// at that place, linear between its pixels. l, r: both views' central differences there, the right view's linear between
/// pixels, too; g their mean. A tap with |e| >= kMostDifference does not count: it sees something else. A step is one of the
/// four pixels of rows 2k, 2k + 1 and columns 2j, 2j + 1, over the taps of the rows 2k +- 2 kReach and the columns 2j +- 2
/// kReach, each at its own disparity, so that a slant changes nothing: step = -9/4 sum(e g w) / sum(max(l r, 0) w + 1/20),
/// rounded to 1/16 px and held to
/// +-kMost_q4; the result is held to 0 .. max_disparity - 1. w = 1 / (g^2 + 8): paths flatten where there is little to see, and
/// there gradients of shading must not be outvoted by a few strong ones, whose disparities are right already. These still hold
/// the others back, hence 9/4. Noise of the views, which are independent, is in l r only by chance, where g^2 would always be
/// more by it and steps be shorter the noisier the pictures are. Where there is no gradient nothing changes.
///
/// Shape    all H x W; dst is not the same memory as d_q4
/// Units    d_q4 1/16 px, Disparity::kNone = hole, which stays one; e in gray levels, g in those per px
/// Threads  pairs of rows are independent
/// Exact    ref, simd and vk agree bit for bit: integers, e in 1/16, g in 1/4, l r in 1/16; what a tap adds is rounded once,
/// see
///          lucas_kanade_params.h; sums stay below 2^26
/// Source   Lucas, Kanade, "An iterative image registration technique with an application to stereo vision", 1981; a step past
///          the least sum as in Young, "Iterative methods for solving partial difference equations of elliptic type", 1954
///          (over-relaxation); taps at disparities of their own, each fourth pixel, are ours
struct LucasKanade {
  static constexpr int kReach = kLucasKanadeReach, kMostDifference = kLucasKanadeMostDifference, kMost_q4 = kLucasKanadeMost_q4;
  static constexpr int kRows = 2 * kReach + 1;  // what a row depends on, up and down
  static constexpr int kMostGradient_q2 = 510;

  View<const std::uint8_t> left, right;
  View<const std::uint16_t> d_q4;
  int max_disparity = 0;
  RowBand rows = {};  // of dst that are needed; others may hold anything
};

/// What a tap adds to the sums, and these themselves: of e g w, and of max(l r, 0) w + 1/20.
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
  /// For pictures of this size, and smaller ones.
  LucasKanadeScratch(Size size, int threads);

  static constexpr int kRows = 2 * LucasKanade::kReach + 1, kBefore = 32;  // rows of taps in use; taps around a row
  struct Thread {
    Image<std::int32_t> pull, weight;  // of rows of taps: [row % kRows]
    Image<std::int32_t> sums;          // of both over the rows of the window, and of three columns of them
    Image<std::int32_t> steps;         // of a pair of rows, twice 16 bits a tap
  };
  std::vector<Thread> threads;
};
void lucas_kanade(Pool& pool, const LucasKanade& in, LucasKanadeScratch& scratch, View<std::uint16_t> dst);
}  // namespace simd

}  // namespace duo
