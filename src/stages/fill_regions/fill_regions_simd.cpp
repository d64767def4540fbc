// Only the flat pixels are loops that compilers make vectors of: regions are union-find and look-ups, plain rows on all
// threads.
#include <algorithm>
#include <cstdlib>

#include "core/check.h"
#include "stages/fill_regions/fill_regions.h"

namespace duo::simd {
namespace {

using In = FillRegions;

void flat_row(View<const std::uint8_t> gray, int y, std::uint8_t* out) {
  constexpr int kRun = 256;  // columns worked on together
  const int w = gray.width(), h = gray.height();
  const std::uint8_t *up = gray.row(std::max(y - 1, 0)), *mid = gray.row(y), *down = gray.row(std::min(y + 1, h - 1));
  std::int16_t sums[kRun + 2], differences[kRun + 2];  // of a column's three pixels, one column to either side
  for (int x0 = 0; x0 < w; x0 += kRun) {
    const int n = std::min(kRun, w - x0), first = x0 == 0 ? 1 : 0, last = x0 + n == w ? n : n + 1;
    for (int i = first; i <= last; ++i) {
      const int x = x0 + i - 1;
      sums[i] = static_cast<std::int16_t>(up[x] + 2 * mid[x] + down[x]);
      differences[i] = static_cast<std::int16_t>(down[x] - up[x]);
    }
    if (first == 1) sums[0] = sums[1], differences[0] = differences[1];
    if (last == n) sums[n + 1] = sums[n], differences[n + 1] = differences[n];
    for (int i = 0; i < n; ++i) {
      const int along_x = std::abs(sums[i + 2] - sums[i]);
      const int along_y = std::abs(differences[i] + 2 * differences[i + 1] + differences[i + 2]);
      out[x0 + i] = along_x <= In::kFlatGradient && along_y <= In::kFlatGradient ? 1 : 0;
    }
  }
}

struct FlatSurface {
  View<const std::uint8_t> flat, gray;
  bool member(int y, int x) const { return flat.at(y, x) != 0; }
  bool joined(int y, int x, int y2, int x2) const { return std::abs(gray.at(y, x) - gray.at(y2, x2)) <= In::kFlatStep; }
};

using Forest = RunForest<FlatSurface>;

void find_flat(Pool& pool, View<const std::uint8_t> gray, FillRegionsScratch& s) {
  pool.rows(gray.height(), [&](int begin, int end) {
    for (int y = begin; y < end; ++y) {
      flat_row(gray, y, s.flat.row(y));
      std::fill_n(s.region.row(y), gray.width(), 0);
    }
  });
}

/// Numbers the large regions in reading order; returns how many.
int number_regions(Pool& pool, const Forest& forest, FillRegionsScratch& s) {
  const int h = s.region.height();
  int count = 0;
  for (int y = 0; y < h; ++y)
    for (int i = 0; i < forest.runs_in(y); ++i)
      if (const auto& run = forest.run(y, i); forest.is_root(y, i) && run.pixels >= In::kFewestPixels) {
        s.region.at(y, run.begin) = ++count;  // where its other runs look it up
        s.regions[static_cast<std::size_t>(count)] = {.pixels = run.pixels};
      }
  pool.rows(h, [&](int begin, int end) {
    for (int y = begin; y < end; ++y)
      for (int i = 0; i < forest.runs_in(y); ++i) {
        const int root = forest.root(y, i);
        if (forest.at(root).pixels < In::kFewestPixels) continue;
        const int number = s.region.at(forest.row_of(root), forest.at(root).begin);
        std::int32_t* row = s.region.row(y);
        std::fill(row + forest.run(y, i).begin + forest.is_root(y, i), row + forest.run(y, i).end, number);
      }
  });
  return count;
}

/// Calls f(y, run, region) for the runs of all regions.
template <class F>
void each_run(const Forest& forest, FillRegionsScratch& s, int begin, int end, const F& f) {
  for (int y = begin; y < end; ++y)
    for (int i = 0; i < forest.runs_in(y); ++i) {
      const auto& run = forest.run(y, i);
      if (const int number = s.region.at(y, run.begin); number != 0) f(y, run, s.regions[static_cast<std::size_t>(number)]);
    }
}

bool wants_points(const FillRegionsScratch::Region& region) { return In::kHolesOf * region.holes >= region.pixels; }

/// Calls f(y, x, region) for the measured pixels that have their region to all sides, in reading order, of those with enough
/// holes.
template <class F>
void each_inner(const Forest& forest, FillRegionsScratch& s, View<const std::uint16_t> d_q4, const F& f) {
  each_run(forest, s, In::kInnerRows, d_q4.height() - In::kInnerRows, [&](int y, const auto& run, auto& region) {
    if (!wants_points(region)) return;
    const int number = s.region.at(y, run.begin);
    for (int x = run.begin + In::kInnerColumns; x < run.end - In::kInnerColumns; ++x) {
      if (d_q4.at(y, x) == Disparity::kNone) continue;
      bool inner = true;
      for (int k = 1; k <= In::kInnerRows; ++k) inner &= s.region.at(y - k, x) == number && s.region.at(y + k, x) == number;
      if (inner) f(y, x, region);
    }
  });
}

/// The points of all regions with enough holes, one region after the other.
void collect_points(const Forest& forest, FillRegionsScratch& s, int count, View<const std::uint16_t> d_q4) {
  each_run(forest, s, 0, d_q4.height(), [&](int y, const auto& run, auto& region) {
    const std::uint16_t* row = d_q4.row(y);
    region.holes += static_cast<int>(std::count(row + run.begin, row + run.end, Disparity::kNone));
  });
  each_inner(forest, s, d_q4, [](int, int, auto& region) { ++region.points; });
  std::size_t first = 0;
  for (int i = 1; i <= count; ++i) {
    auto& region = s.regions[static_cast<std::size_t>(i)];
    region.first = first;
    first += region.points;
    region.points = 0;
  }
  each_inner(forest, s, d_q4, [&](int y, int x, auto& region) {
    s.points[region.first + region.points++] = {static_cast<std::uint16_t>(y), static_cast<std::uint16_t>(x), d_q4.at(y, x)};
  });
}

}  // namespace

FillRegionsScratch::FillRegionsScratch(Size size)
    : flat(size),
      runs(size),
      region(size),
      regions(static_cast<std::size_t>(size.width) * static_cast<std::size_t>(size.height) / In::kFewestPixels + 1),
      points(static_cast<std::size_t>(size.width) * static_cast<std::size_t>(size.height)) {}

void fill_regions(Pool& pool, const FillRegions& in, FillRegionsScratch& scratch, View<std::uint16_t> d_q4,
                  View<std::uint8_t> origin) {
  DUO_CHECK(in.gray.size() == d_q4.size() && origin.size() == d_q4.size() && in.max_disparity >= 1);
  DUO_CHECK(scratch.flat.size() == d_q4.size());
  find_flat(pool, in.gray, scratch);
  Forest forest(d_q4.size(), {scratch.flat, in.gray}, scratch.runs);
  forest.build(pool);
  const int count = number_regions(pool, forest, scratch);
  if (count == 0) return;
  collect_points(forest, scratch, count, d_q4);
  pool.rows(count, [&](int begin, int end) {
    for (int i = begin + 1; i <= end; ++i) {
      auto& region = scratch.regions[static_cast<std::size_t>(i)];
      region.fills = region_plane({scratch.points.data() + region.first, region.points}, region.plane);
    }
  });
  pool.rows(d_q4.height(), [&](int begin, int end) {
    each_run(forest, scratch, begin, end, [&](int y, const auto& run, const auto& region) {
      for (int x = run.begin; region.fills && x < run.end; ++x) {
        if (d_q4.at(y, x) != Disparity::kNone) continue;
        const int d = region.plane.d_q4(y, x);
        if (d < 0 || d > 16 * (in.max_disparity - 1)) continue;
        d_q4.at(y, x) = static_cast<std::uint16_t>(d);
        origin.at(y, x) = static_cast<std::uint8_t>(Origin::kFilled);
      }
    });
  });
}

}  // namespace duo::simd
