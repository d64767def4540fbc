// Runs instead of pixels; scalar, for marks are mostly empty and what is not is in few runs.

#include <algorithm>
#include <limits>

#include "core/check.h"
#include "stages/region/region.h"

namespace duo::simd {
namespace {

struct Marked {
  View<const std::uint8_t> marks;
  int mask;
  bool member(int y, int x) const { return (marks.at(y, x) & mask) != 0; }
  static bool joined(int, int, int, int) { return true; }
};

/// The root to keep, -1 = none.
int nearest(const RunForest<Marked>& forest, int height, Pixel seed) {
  int best = -1;
  std::int64_t least = std::numeric_limits<std::int64_t>::max();
  for (int y = 0; y < height; ++y)
    for (int i = 0; i < forest.runs_in(y); ++i) {
      const auto& run = forest.run(y, i);
      const std::int64_t dx = std::clamp(seed.x, int{run.begin}, run.end - 1) - seed.x, dy = y - seed.y;
      if (dx * dx + dy * dy >= least) continue;
      least = dx * dx + dy * dy;
      best = forest.root(y, i);
    }
  return best;
}

}  // namespace

RegionLabel keep_region(Pool& pool, const Region& in, View<std::uint8_t> all, RunForestScratch& scratch) {
  DUO_CHECK(in.bit >= 0 && in.bit < 8);
  const Window window = in.window.within(all.size());
  if (window.empty()) return {};
  // In the window's own coordinates.
  const View<std::uint8_t> marks = all.crop(window.y, window.x, {window.width, window.height});
  RunForest<Marked> forest(marks.size(), {marks, 1 << in.bit}, scratch);
  forest.build(pool);
  const int kept = nearest(forest, marks.height(), {in.seed.y - window.y, in.seed.x - window.x});
  const auto others = static_cast<std::uint8_t>(~(1 << in.bit));
  pool.rows(marks.height(), [&](int begin, int end) {
    for (int y = begin; y < end; ++y) {
      std::uint8_t* row = marks.row(y);
      const auto clear = [&](int from, int to) {
        for (int x = from; x < to; ++x) row[x] &= others;
      };
      int x = 0;
      for (int i = 0; i < forest.runs_in(y); ++i) {
        if (forest.root(y, i) != kept) continue;
        clear(x, forest.run(y, i).begin);
        x = forest.run(y, i).end;
      }
      clear(x, marks.width());
    }
  });
  if (kept < 0) return {};
  const int first_y = forest.row_of(kept) + window.y, first_x = forest.at(kept).begin + window.x;
  return {first_y * all.width() + first_x, forest.at(kept).pixels};
}

}  // namespace duo::simd
