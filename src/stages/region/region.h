// The connected region of a target: one hand, not everything of its colour.
#pragma once

#include <cstdint>

#include "core/pool.h"
#include "core/run_forest.h"
#include "core/targets.h"

namespace duo {

/// Clears a target's bit everywhere in its window but in one 4-connected region, and returns that region's label.
///
/// With a disparity picture, neighbours connect only where both are known and differ by at most `step_q4`, and pixels without
/// disparity belong to no region: they are often just those that border on something behind.
/// kNearest: the region of the pixel nearest to the seed, first in reading order where several are; the seed may lie anywhere.
/// kLargest: the region of most pixels, lowest label where several are.
/// The label is the row-major index y * W + x of the region's first pixel; without any marked pixel none.
///
/// Shape    marks and d_q4 H x W; marks are changed in place, only bit `bit` and only inside the window
/// Units    1/16 px; window and seed in pixels of the picture
/// Border   a window ends regions as the picture's border does
/// Threads  bands in parallel; the result does not depend on them
/// Exact    ref, simd and vk agree bit for bit
/// Source   connected components by union-find (core/run_forest.h); the cut at depth steps is ours, against walls of skin
/// colour
struct Region {
  enum class Pick : std::uint8_t { kNearest, kLargest };
  int bit = 0;  // its number
  Window window;
  Pick pick = Pick::kNearest;
  Pixel seed = {};
  View<const std::uint16_t> d_q4 = {};
  int step_q4 = 0;
};

namespace ref {
RegionLabel keep_region(const Region& in, View<std::uint8_t> marks);
}
namespace simd {
RegionLabel keep_region(Pool& pool, const Region& in, View<std::uint8_t> marks, RunForestScratch& scratch);
}

}  // namespace duo
