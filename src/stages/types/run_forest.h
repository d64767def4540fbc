// Connected components of a picture by union-find over the runs of its rows: a row has far fewer runs than pixels.
#pragma once

#include <algorithm>
#include <cstdint>

#include "core/check.h"
#include "core/pool.h"
#include "duoptic/image.h"

namespace duo {

/// The memory of a RunForest, for pictures up to `size`.
struct RunForestScratch {
  struct Run {
    std::int32_t parent, pixels;  // index of a run before it, or its own; pixels of the whole component at the root
    std::uint16_t begin, end;     // columns [begin, end)
  };
  Image<Run> runs;             // row y holds its runs; a row of W pixels has at most W
  Image<std::int32_t> counts;  // 1 x H: how many
  RunForestScratch() = default;
  explicit RunForestScratch(Size size) : runs(size), counts({size.height, 1}) {}
};

/// Finds the 4-connected components of pixels that `links` joins; the root of a component is its first run in reading order.
///
/// Links has  bool member(y, x): belongs to a component at all
///            bool joined(y, x, y2, x2): two members side by side belong together; symmetric
///
/// Threads  bands of rows in parallel, joined at their borders; the result does not depend on the bands
/// Source   Tarjan, "Efficiency of a good but not linear set union algorithm", 1975; here the earlier root wins, which makes
/// the
///          roots independent of the order of joins
template <class Links>
class RunForest {
 public:
  using Run = RunForestScratch::Run;

  RunForest(Size size, const Links& links, RunForestScratch& scratch)
      : size_(size), links_(links), runs_(scratch.runs.view()), counts_(scratch.counts.row(0)) {
    DUO_CHECK(scratch.runs.width() >= size.width && scratch.runs.height() >= size.height && size.width < 1 << 16);
  }

  void build(Pool& pool) {
    constexpr int kBand = 32;  // rows joined without looking outside; their borders are joined afterwards
    pool.rows(
        size_.height,
        [&](int begin, int end) {
          for (int y = begin; y < end; ++y) {
            find_runs(y);
            if (y % kBand != 0) join_up(y);
          }
        },
        kBand);
    for (int y = kBand; y < size_.height; y += kBand) join_up(y);
  }

  int runs_in(int y) const { return counts_[y]; }
  const Run& run(int y, int i) const { return runs_.at(y, i); }
  bool is_root(int y, int i) const { return runs_.at(y, i).parent == index(y, i); }
  /// The root of a run as an index that grows in reading order; only reads, so threads may ask at the same time.
  int root(int y, int i) const {
    int at_run = index(y, i);
    while (at(at_run).parent != at_run) at_run = at(at_run).parent;
    return at_run;
  }
  int row_of(int root) const { return static_cast<int>(root / runs_.stride()); }
  const Run& at(int i) const { return runs_.data()[i]; }

 private:
  int index(int y, int i) const { return static_cast<int>(y * runs_.stride()) + i; }

  void find_runs(int y) {
    const int w = size_.width, first = index(y, 0);
    Run* run = runs_.row(y);
    int count = 0;
    for (int x = 0; x < w;) {
      if (!links_.member(y, x)) {
        ++x;
        continue;
      }
      int end = x + 1;
      while (end < w && links_.member(y, end) && links_.joined(y, end - 1, y, end)) ++end;
      run[count] = {first + count, end - x, static_cast<std::uint16_t>(x), static_cast<std::uint16_t>(end)};
      ++count;
      x = end;
    }
    counts_[y] = count;
  }

  /// Joins the runs of row y with those of row y - 1 that touch them.
  void join_up(int y) {
    const Run *here = runs_.row(y), *above = runs_.row(y - 1);
    for (int i = 0, j = 0; i < counts_[y] && j < counts_[y - 1];) {
      const int begin = std::max(here[i].begin, above[j].begin), end = std::min(here[i].end, above[j].end);
      for (int x = begin; x < end; ++x)
        if (links_.joined(y - 1, x, y, x)) {
          join(index(y, i), index(y - 1, j));
          break;
        }
      here[i].end < above[j].end ? ++i : ++j;
    }
  }

  void join(int a, int b) {
    a = find(a);
    b = find(b);
    if (a == b) return;
    if (b < a) std::swap(a, b);
    runs_.data()[b].parent = a;
    runs_.data()[a].pixels += at(b).pixels;
  }
  int find(int i) {
    Run* runs = runs_.data();
    while (runs[i].parent != i) i = runs[i].parent = runs[runs[i].parent].parent;
    return i;
  }

  Size size_;
  Links links_;
  View<Run> runs_;
  std::int32_t* counts_;
};

}  // namespace duo
