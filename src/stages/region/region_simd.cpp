// Runs instead of pixels; scalar, for marks are mostly empty and what is not is in few runs.

#include <algorithm>
#include <cstdlib>
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

struct MarkedSurface {
  View<const std::uint8_t> marks;
  int mask;
  View<const std::uint16_t> d_q4;
  int step_q4;
  bool member(int y, int x) const { return (marks.at(y, x) & mask) != 0 && d_q4.at(y, x) != Disparity::kNone; }
  bool joined(int y, int x, int y2, int x2) const { return std::abs(d_q4.at(y, x) - d_q4.at(y2, x2)) <= step_q4; }
};

/// The root to keep, -1 = none.
template <class Forest>
int largest(const Forest& forest, int height) {
  int best = -1;
  for (int y = 0; y < height; ++y)
    for (int i = 0; i < forest.runs_in(y); ++i)
      if (forest.is_root(y, i) && (best < 0 || forest.run(y, i).pixels > forest.at(best).pixels)) best = forest.root(y, i);
  return best;
}

template <class Forest>
int nearest(const Forest& forest, int height, Pixel seed) {
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

/// Works in the window's own coordinates.
template <class Links>
RegionLabel keep(Pool& pool, const Region& in, const Window& window, const Links& links, View<std::uint8_t> marks, Size picture,
                 RunForestScratch& scratch) {
  RunForest<Links> forest(marks.size(), links, scratch);
  forest.build(pool);
  const Pixel seed{in.seed.y - window.y, in.seed.x - window.x};
  const int kept = in.pick == Region::Pick::kLargest ? largest(forest, marks.height()) : nearest(forest, marks.height(), seed);
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
  return {first_y * picture.width + first_x, forest.at(kept).pixels};
}

}  // namespace

RegionLabel keep_region(Pool& pool, const Region& in, View<std::uint8_t> marks, RunForestScratch& scratch) {
  DUO_CHECK(in.bit >= 0 && in.bit < 8 && (in.d_q4.empty() || in.d_q4.size() == marks.size()));
  const Window window = in.window.within(marks.size());
  if (window.empty()) return {};
  const Size size{window.width, window.height};
  const View<std::uint8_t> part = marks.crop(window.y, window.x, size);
  if (in.d_q4.empty()) return keep(pool, in, window, Marked{part, 1 << in.bit}, part, marks.size(), scratch);
  const MarkedSurface links{part, 1 << in.bit, in.d_q4.crop(window.y, window.x, size), in.step_q4};
  return keep(pool, in, window, links, part, marks.size(), scratch);
}

}  // namespace duo::simd
