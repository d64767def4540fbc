// Which disparities a tile tries: those found nearby at the coarser level.
#pragma once

#include <cstdint>

#include "core/pool.h"
#include "stages/types/tile_sets.h"

namespace duo {

/// Fills the sets of a level from the winners of the coarser one.
///
/// A tile's set holds 2 d - margin .. 2 d + 1 + margin for every checked winner d within its footprint grown by `grow` coarse
/// pixels. Where none survived the check (as along the left border) the footprint grows by half a tile more; where still none
/// did, the unchecked winners there stand in. So the sets follow depth edges, and thin things that any pixel nearby still saw.
///
/// Shape    checked, unchecked: the coarser level's size; sets: of this level
/// Units    px of the coarser level, -1 = none
/// Threads  tile rows are independent
/// Exact    ref, simd and vk agree bit for bit
/// Source   ours; neighbours' candidates as in coarse-to-fine practice, sets instead of ranges so that two surfaces in one tile
/// do
///          not cost all the depth between them
struct TileCandidates {
  View<const std::int16_t> checked, unchecked;
  int grow = 1, margin = 1;
};

/// Every disparity for every tile: the coarsest level.
void all_candidates(TileSets& sets);

namespace ref {
void tile_candidates(const TileCandidates& in, TileSets& sets);
}
namespace simd {
void tile_candidates(Pool& pool, const TileCandidates& in, TileSets& sets);
}

}  // namespace duo
