// Removes small islands of disparity: what agrees with too few neighbours is a mismatch.
#pragma once

#include <cstdint>

#include "core/pool.h"
#include "duoptic/frame.h"
#include "stages/types/run_forest.h"

namespace duo {

// Neighbours (4-connected) belong together where both are known and differ by at most `step_q4`; islands of fewer than
// `smallest` pixels become Disparity::kNone.
//
// Shape    d_q4 H x W, changed in place
// Units    1/16 px
// Threads  simd: bands in parallel, joined at their borders; the result does not depend on the bands
// Exact    ref, simd and vk agree bit for bit
// Source   connected components by union-find (stages/types/run_forest.h)
namespace ref {
void remove_speckle(View<std::uint16_t> d_q4, int step_q4, int smallest);
}
namespace simd {
using SpeckleScratch = RunForestScratch;
/// The scratch is made for pictures that are at least as large.
void remove_speckle(Pool& pool, View<std::uint16_t> d_q4, int step_q4, int smallest, SpeckleScratch& scratch);
}  // namespace simd

}  // namespace duo
