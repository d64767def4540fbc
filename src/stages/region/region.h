// One connected region of a mark: one hand, not everything of its colour.
#pragma once

#include <cstdint>

#include "core/area.h"
#include "core/pool.h"
#include "stages/types/run_forest.h"

namespace duo {

/// A connected region: the row-major index y * W + x of its first pixel, -1 = none, and how many pixels it has.
struct RegionLabel {
  std::int32_t label = -1, pixels = 0;
  friend bool operator==(const RegionLabel&, const RegionLabel&) = default;
};

/// Clears one bit everywhere in its window but in the 4-connected region of the pixel nearest to the seed (first in reading
/// order where several are), and returns that region's label; none without any marked pixel. The seed may lie anywhere.
///
/// Shape    marks H x W, changed in place, only bit `bit` and only inside the window
/// Units    window and seed in pixels of the picture
/// Border   a window ends regions as the picture's border does
/// Threads  bands in parallel; the result does not depend on them
/// Exact    ref, simd and vk agree bit for bit
/// Source   connected components by union-find (stages/types/run_forest.h)
struct Region {
  int bit = 0;  // its number
  Window window;
  Pixel seed = {};
};

namespace ref {
RegionLabel keep_region(const Region& in, View<std::uint8_t> marks);
}
namespace simd {
RegionLabel keep_region(Pool& pool, const Region& in, View<std::uint8_t> marks, RunForestScratch& scratch);
}

}  // namespace duo
