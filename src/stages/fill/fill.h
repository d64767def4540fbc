// Fills holes from the background.
#pragma once

#include <cstdint>

#include "core/pool.h"
#include "core/row_band.h"
#include "duoptic/frame.h"

namespace duo {

// A run of holes on a row takes, pixel by pixel, the smaller of what the surfaces at its two ends would have there: what is
// hidden from one camera belongs to the surface behind. A run at the picture's edge has one end. Rows without any disparity
// stay holes. Filled pixels are marked Origin::kFilled.
//
// Surface at an end: the line along the row that fits best, by squares, to the disparities around the end; with fewer than 12
// of them, or a run shorter than 8 px, the end's disparity alone. Around: in rows y - 4, y - 2 .. y + 4 the columns 0, 2 .. 22
// px away from the run, counted from the end; in each row up to the first hole, or the first disparity that differs from the
// end's by more than 24 + its columns in 1/16 px: a surface rises by one in sixteen at most. Slopes are in 1/256 of that,
// rounded to 0, the values of the line to the nearest 1/16 px and held to 0 .. max_disparity - 1.
//
// Shape    src, origin and dst H x W; dst is not src; origin is kNone exactly where src has none
// Units    1/16 px
// Threads  rows are independent; simd runs the plain rows on all threads, as runs are short and differ in length
// Exact    ref and simd agree bit for bit: integers
// Source   after the row-minimum fill of the Middlebury evaluations (Scharstein, Szeliski 2002), whose values are constant
//
// mark_measured: origin is kMeasured where there is a disparity, else kNone; it comes first.
//
// take_filled: a hole takes what the matcher says that it would have, where it says so; plain loops are fast enough.
void take_filled(View<const std::uint16_t> filled, View<std::uint16_t> d_q4, View<std::uint8_t> origin);
namespace ref {
void mark_measured(View<const std::uint16_t> d_q4, View<std::uint8_t> origin);
void fill(View<const std::uint16_t> src, int max_disparity, View<std::uint8_t> origin, View<std::uint16_t> dst,
          RowBand rows = {});
}  // namespace ref
namespace simd {
void mark_measured(Pool& pool, View<const std::uint16_t> d_q4, View<std::uint8_t> origin);
void fill(Pool& pool, View<const std::uint16_t> src, int max_disparity, View<std::uint8_t> origin, View<std::uint16_t> dst);
}  // namespace simd

}  // namespace duo
