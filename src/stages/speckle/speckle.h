// Removes small islands of disparity: what agrees with too few neighbours is a mismatch.
#pragma once

#include <cstdint>

#include "core/pool.h"
#include "duoptic/frame.h"

namespace duo {

// Neighbours (4-connected) belong together where both are known and differ by at most `step_q4`; islands of fewer than
// `smallest` pixels become Disparity::kNone.
//
// Shape    d_q4 H x W, changed in place
// Units    1/16 px
// Threads  simd: bands in parallel, joined at their borders; the result does not depend on the bands
// Exact    ref and simd agree bit for bit
// Source   connected components by union-find; Tarjan, "Efficiency of a good but not linear set union algorithm", 1975
namespace ref {
void remove_speckle(View<std::uint16_t> d_q4, int step_q4, int smallest);
}
namespace simd {
/// Runs of each row and the forest over them.
struct SpeckleScratch {
  struct Run {
    std::int32_t parent, pixels;  // index of the run above it in the forest; pixels of the whole island at the root
    std::uint16_t begin, end;     // columns [begin, end)
  };
  Image<Run> runs;             // row y holds its runs; a row of W pixels has at most W
  Image<std::int32_t> counts;  // 1 x H: how many
  SpeckleScratch() = default;
  explicit SpeckleScratch(Size size) : runs(size), counts({size.height, 1}) {}
};
void remove_speckle(Pool& pool, View<std::uint16_t> d_q4, int step_q4, int smallest, SpeckleScratch& scratch);
}  // namespace simd

}  // namespace duo
