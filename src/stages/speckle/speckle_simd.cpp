// Union-find over runs instead of pixels: a smooth row has a handful of runs. Scalar, but each pixel is touched three times
// only.

#include <algorithm>
#include <cstdlib>

#include "core/check.h"
#include "stages/speckle/speckle.h"

namespace duo::simd {
namespace {

struct SmoothSurface {
  View<const std::uint16_t> d_q4;
  int step_q4;
  bool member(int y, int x) const { return d_q4.at(y, x) != Disparity::kNone; }
  bool joined(int y, int x, int y2, int x2) const { return std::abs(d_q4.at(y, x) - d_q4.at(y2, x2)) <= step_q4; }
};

}  // namespace

void remove_speckle(Pool& pool, View<std::uint16_t> d_q4, int step_q4, int smallest, SpeckleScratch& scratch) {
  DUO_CHECK(scratch.runs.width() >= d_q4.width() && scratch.runs.height() >= d_q4.height());
  RunForest<SmoothSurface> islands(d_q4.size(), {d_q4, step_q4}, scratch);
  islands.build(pool);
  pool.rows(d_q4.height(), [&](int begin, int end) {
    for (int y = begin; y < end; ++y)
      for (int i = 0; i < islands.runs_in(y); ++i) {
        const auto& run = islands.run(y, i);
        if (islands.at(islands.root(y, i)).pixels < smallest)
          std::fill(d_q4.row(y) + run.begin, d_q4.row(y) + run.end, Disparity::kNone);
      }
  });
}

}  // namespace duo::simd
