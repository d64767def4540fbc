// Union-find over runs instead of pixels: a smooth row has a handful of runs. Scalar, but each pixel is touched three times only.

#include <algorithm>
#include <cstdlib>

#include "core/check.h"
#include "stages/speckle/speckle.h"

namespace duo::simd {
namespace {

using Run = SpeckleScratch::Run;

class Islands {
 public:
  Islands(View<std::uint16_t> d_q4, int step_q4, SpeckleScratch& scratch)
      : d_(d_q4), step_(step_q4), runs_(scratch.runs.view()), counts_(scratch.counts.row(0)) {}

  void find_runs(int y) {
    const std::uint16_t* d = d_.row(y);
    const int w = d_.width(), first = index(y, 0);
    Run* run = runs_.row(y);
    int count = 0;
    for (int x = 0; x < w;) {
      if (d[x] == Disparity::kNone) {
        ++x;
        continue;
      }
      int end = x + 1;
      while (end < w && d[end] != Disparity::kNone && std::abs(d[end] - d[end - 1]) <= step_) ++end;
      run[count] = {first + count, end - x, static_cast<std::uint16_t>(x), static_cast<std::uint16_t>(end)};
      ++count;
      x = end;
    }
    counts_[y] = count;
  }

  /// Joins the runs of row y with those of row y - 1 that touch them.
  void join_up(int y) {
    const std::uint16_t *d = d_.row(y), *up = d_.row(y - 1);
    const Run *here = runs_.row(y), *above = runs_.row(y - 1);
    for (int i = 0, j = 0; i < counts_[y] && j < counts_[y - 1];) {
      const int begin = std::max(here[i].begin, above[j].begin), end = std::min(here[i].end, above[j].end);
      for (int x = begin; x < end; ++x)
        if (std::abs(d[x] - up[x]) <= step_) {
          join(index(y, i), index(y - 1, j));
          break;
        }
      here[i].end < above[j].end ? ++i : ++j;
    }
  }

  /// Needs every join done; only reads the forest, so rows may go in parallel.
  void remove_small(int y, int smallest) const {
    for (int i = 0; i < counts_[y]; ++i) {
      const Run& run = runs_.at(y, i);
      int root = index(y, i);
      while (at(root).parent != root) root = at(root).parent;
      if (at(root).pixels < smallest) std::fill(d_.row(y) + run.begin, d_.row(y) + run.end, Disparity::kNone);
    }
  }

 private:
  int index(int y, int i) const { return static_cast<int>(y * runs_.stride()) + i; }
  Run& at(int i) const { return runs_.data()[i]; }
  int root_of(int i) {
    while (at(i).parent != i) i = at(i).parent = at(at(i).parent).parent;
    return i;
  }
  void join(int a, int b) {
    a = root_of(a);
    b = root_of(b);
    if (a == b) return;
    if (at(a).pixels < at(b).pixels) std::swap(a, b);
    at(b).parent = a;
    at(a).pixels += at(b).pixels;
  }

  View<std::uint16_t> d_;
  int step_;
  View<Run> runs_;
  std::int32_t* counts_;
};

}  // namespace

void remove_speckle(Pool& pool, View<std::uint16_t> d_q4, int step_q4, int smallest, SpeckleScratch& scratch) {
  DUO_CHECK(scratch.runs.size() == d_q4.size());
  constexpr int kBand = 32;  // rows joined without looking outside; their borders are joined afterwards
  Islands islands(d_q4, step_q4, scratch);
  const int h = d_q4.height();
  pool.rows(h, [&](int begin, int end) {
    for (int y = begin; y < end; ++y) {
      islands.find_runs(y);
      if (y % kBand != 0) islands.join_up(y);
    }
  }, kBand);
  for (int y = kBand; y < h; y += kBand) islands.join_up(y);
  pool.rows(h, [&](int begin, int end) {
    for (int y = begin; y < end; ++y) islands.remove_small(y, smallest);
  });
}

}  // namespace duo::simd
