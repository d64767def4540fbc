// Semi-global matching: pixel costs aggregated along straight paths, then a winner for each pixel of both views.
#pragma once

#include <algorithm>
#include <array>
#include <atomic>
#include <cstdint>
#include <memory>
#include <vector>

#include "core/pool.h"
#include "core/row_band.h"
#include "duoptic/frame.h"
#include "stages/types/match_planes.h"

namespace duo {

struct SemiGlobalParams {
  int census_truncation = 10;  // most that the census adds to a pixel's cost, 0 .. 16
  int truncation = 7;          // most that each of the three channels adds, 0 .. 32
  int p1 = 20;                 // penalty of a step of one disparity
  int p2 = 40;                 // penalty of a larger step where the picture is flat, p1 .. 112
  int p2_least = 22;           // and the least of it, p1 .. p2
  int p2_gradient = 16;        // gray step that halves p2
  bool diagonals = false;      // paths along diagonals, too
  bool upward = false;         // paths from the row below, too

  int paths() const { return 2 + (diagonals ? 3 : 1) * (upward ? 2 : 1); }
  /// The penalty of a larger step between pixels whose gray values differ by `step`.
  int p2_at(int step) const { return std::max(p2_least, p2 * p2_gradient / (p2_gradient + step)); }
};

/// Disparity of each pixel of both views.
///
/// Cost C(x, d) of left pixel x and right pixel x - d: min(census_truncation, differing census bits) plus, of each channel,
/// min(truncation, distance of each value to the other's interval, the smaller one). Most there is where one of them is
/// outside. Path cost along direction r: L(p, d) = C(p, d) + min(L'(d), L'(d - 1) + p1, L'(d + 1) + p1, min L' + P2) - min L',
/// L' = L(p - r), and L = C where p - r is not in the picture; P2 = p2_at(gray step from p - r to p). S = min(255, sum of L
/// over the paths): left and right along the row, down, with `diagonals` both diagonals down, with `upward` the same from
/// below. Left winner: the least S, the smallest d of equals. Right winner of x: the least S(x + d, d), the smallest d of
/// equals. Sub-pixel, none at the ends of the range: t, the mean of the vertices of a parabola and of a V through S at d - 1,
/// d, d + 1, in units of half a pixel, becomes t (3 - t) / 2: penalties and intervals draw S to whole pixels, this takes back
/// half. Margin: least S at other disparities than d - 1, d, d + 1, minus S(d), 255 taken where there is none. Small =
/// doubtful.
///
/// Shape    planes and outputs H x W; right planes padded by padding() columns
/// Units    left and right px; fine 1/16 px; margin in costs
/// Border   edge columns of the right view continue: d may exceed x
/// Exact    ref, simd and vk agree bit for bit, with any number of threads. All in bytes: C <= 16 + 3 * 32 = 112, L <= C + P2
/// <= 224; where
///          L + p1 would pass 255 it saturates, above min L' + P2 <= 224, and changes nothing
/// Source   Hirschmueller, "Stereo processing by semiglobal matching and mutual information", 2008; P2 by the picture's
/// gradient
///          as there; fractions equalised as in Shimizu, Okutomi, "Precise sub-pixel
///          estimation on area-based matching", 2001, and Haller, Nedevschi 2012; that three paths of one sweep are enough is
///          measured: see matchers/sgm/README.md
struct SemiGlobal {
  MatchPlanes left, right;
  int max_disparity = 0;  // 1 .. 256
  SemiGlobalParams params;
  RowBand rows = {};  // where the outputs are needed; in others they may hold anything, and only paths pass
};
struct SemiGlobalMatch {
  View<std::int16_t> left, right;
  View<std::uint16_t> fine;
  View<std::uint8_t> margin = {};  // may be empty = not wanted
};

namespace ref {
/// The textbook: the whole volume, one path after the other.
void semi_global(const SemiGlobal& in, const SemiGlobalMatch& out);
}  // namespace ref

namespace simd {
/// What one thread does of a sweep. Rows are counted in the sweep's order, from the top or, with `up`, from the bottom. Rows
/// [0, passed) only propagate path costs; rows [passed, kept) also store their sums in the volume; rows [kept, count) pick
/// winners.
struct SemiGlobalPart {
  bool up = false;
  int passed = 0, kept = 0, count = 0;
  // Columns of its team: the whole row, or one half, which is processed from the picture's border to the middle.
  int begin = 0, end = 0;
  int thread = 0, threads = 1;               // which of its team
  int thread_of_all = 0, ring = 0;           // its memory: rows, and the team's first row of path costs
  std::atomic<int>* done = nullptr;          // [row]: pixels finished, in the order of the walk
  const std::atomic<int>* facing = nullptr;  // of the other half; none: this is the whole row
  int facing_width = 0;
  // Where sweeps meet: how many threads have kept their sums.
  std::atomic<int>* sums = nullptr;
  const std::atomic<int>* sums_of_others = nullptr;

  int width() const { return end - begin; }
};

/// The memory of the sweeps: rings of rows of path costs (a row for each thread, and one more for each team), sums and costs of
/// two rows for each thread (seven where threads have halves), and with `upward` one byte for each pixel and disparity.
class SemiGlobalScratch {
 public:
  SemiGlobalScratch(Size size, int max_disparity, const SemiGlobalParams& params, int threads);
  /// For pictures of this size and these disparities, at most those that it was made for.
  void fit(Size size, int max_disparity);
  /// Columns by which the planes must continue to the left.
  static int padding(int max_disparity) { return (max_disparity + kGap - 1) / kGap * kGap; }

  // Rows by which the backward pass over a half follows the forward pass; over a whole row it is one.
  static constexpr int kBehind = 6;
  static constexpr int kGap = 64;  // bytes of 255 between the path costs of two pixels: d = -1 and d = max_disparity
  struct Row {
    Image<std::uint8_t> sums, costs;   // [pixel][disparity]
    Image<std::uint8_t> along, back;   // [2][disparity]: path costs along the row and back, this pixel's and those before
    Image<std::uint8_t> totals;        // S of one pixel
    Image<std::uint8_t> best, winner;  // of the right view, padding() columns before x = 0
    Image<std::uint8_t> beside;        // [2][pixel]: how much more than the winner's S its lower and its higher neighbour have
  };
  Size most;           // that it was made for
  int most_lanes = 0;  // likewise
  int lanes = 0;       // disparities with those that only fill the last vector
  int stride = 0;      // lanes + kGap
  // [row of the ring]: a row for each direction, [pixel][disparity] and [pixel], with a pixel of zeros on both sides.
  std::vector<Image<std::uint8_t>> paths, minima;
  std::uint8_t* first_cell(std::uint8_t* row) const { return row + kGap + stride; }  // of x = 0
  Image<std::uint8_t> none;  // path costs and minima where there is no row before: zeros
  int rows_each = 2;         // of a thread, in use at once
  std::vector<Row> rows;     // [thread][rows_each]
  Row& row(int thread, int turn) { return rows[static_cast<std::size_t>(thread * rows_each + turn % rows_each)]; }
  // Where two halves meet. Of either half [row]: the path costs of its last pixel along the row. And [row][disparity]: what
  // each found of the right pixels left of the middle.
  std::array<Image<std::uint8_t>, 2> met_costs;
  Image<std::uint8_t> met_least, left_best, right_best, right_winner;
  std::uint8_t* met(int half, int y) { return met_costs[static_cast<std::size_t>(half)].row(y) + kGap; }
  Image<std::uint8_t> volume;                // sums of the paths of a sweep, for the sweep from the other side
  std::unique_ptr<std::atomic<int>[]> done;  // [team][row]: pixels finished
  std::unique_ptr<std::atomic<int>[]> sums;  // [team]: threads whose sums are in the volume
  /// Whether vectors of 32 bytes are swept where the processor has those of 64. AMD's Zen 4 takes vectors of 64 bytes in two
  /// turns, and longer than twice 32; Zen 5 gains nothing by them. Not where a test allows one set of instructions alone.
  bool half_vectors = prefers_half_vectors();

 private:
  static bool prefers_half_vectors();
};
void semi_global(Pool& pool, const SemiGlobal& in, SemiGlobalScratch& scratch, const SemiGlobalMatch& out);
}  // namespace simd

}  // namespace duo
