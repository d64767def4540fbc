// Lanes are disparities, downwards: lane j is d = lanes - 1 - j, so that the right pixels x - d of a left pixel lie in order in
// memory. One sweep goes down the rows. On its way along a row each pixel's cost is worked out once, the paths from the left
// and from above are brought up to date together, and their sum stays in the cache; on the way back along the row the path from
// the right is added and both views' winners are picked. Nothing but a few rows is kept. Paths from below need a sweep of their
// own before it, which leaves one byte for each pixel and disparity. Threads take rows in turn; a row may go on as far as the
// row before it is done.

#include "core/check.h"
#include "stages/semi_global/semi_global.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "stages/semi_global/semi_global_simd.cpp"
#include <hwy/foreach_target.h>
// After foreach_target.h, as Highway asks.
#include <hwy/cache_control.h>
#include <hwy/highway.h>

#include "stages/semi_global/semi_global_walks-inl.h"

HWY_BEFORE_NAMESPACE();
namespace duo::HWY_NAMESPACE {

template <bool kDiagonals>
void pass(const Sweep& sweep, int i, Scratch::Row& row) {
  Along<Walk::kPassing, kDiagonals> along(sweep, i, row);
  for (int begin = 0; begin < sweep.w; begin += kBlock) {
    const int end = std::min(begin + kBlock, sweep.w);
    if (i > 0) sweep.wait_for(i - 1, std::min(end + 1, sweep.w));
    along.costs(begin, end);
    for (int x = begin; x < end; ++x) along.pixel(x);
    sweep.finished(i, end);
  }
}

/// A thread walks along one row and back along its last one at the same time: each pixel of a path waits for the pixel before,
/// and two such chains fill each other's waiting.
template <bool kUp, bool kDiagonals>
void run(const Sweep& sweep) {
  const std::size_t rows = 2 * static_cast<std::size_t>(sweep.thread);
  int last = -1, turn = 0, i = sweep.thread;
  for (; i < sweep.passed; i += sweep.threads) pass<kDiagonals>(sweep, i, sweep.s.rows[rows]);
  for (; i < sweep.count; i += sweep.threads, turn ^= 1) {
    Along<kUp ? Walk::kUp : Walk::kDown, kDiagonals> along(sweep, i, sweep.s.rows[rows + static_cast<std::size_t>(turn)]);
    Back back(sweep, std::max(last, 0), sweep.s.rows[rows + static_cast<std::size_t>(turn ^ 1)]);
    for (int begin = 0; begin < sweep.w; begin += kBlock) {
      const int end = std::min(begin + kBlock, sweep.w);
      if (i > 0) sweep.wait_for(i - 1, std::min(end + 1, sweep.w));
      along.costs(begin, end);
      for (int x = begin; x < end; ++x) {
        along.pixel(x);
        if (!kUp && last >= 0) back.pixel(sweep.w - 1 - x);
      }
      sweep.finished(i, end);
    }
    if (!kUp && last >= 0) back.finish();
    last = i;
  }
  if (kUp) hwy::FlushStream();
  if (kUp || last < 0) return;
  Back back(sweep, last, sweep.s.rows[rows + static_cast<std::size_t>(turn ^ 1)]);
  for (int x = sweep.w - 1; x >= 0; --x) back.pixel(x);
  back.finish();
}

template <bool kUp>
void run(const Sweep& sweep) {
  sweep.in.params.diagonals ? run<kUp, true>(sweep) : run<kUp, false>(sweep);
}

void sweep(const SemiGlobal& in, Scratch& scratch, const SemiGlobalMatch& out, int thread, int threads, bool up) {
  const Sweep here(in, scratch, out, thread, threads, up);
  up ? run<true>(here) : run<false>(here);
}

}  // namespace duo::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace duo {
HWY_EXPORT(sweep);

namespace simd {

void semi_global(Pool& pool, const SemiGlobal& in, SemiGlobalScratch& scratch, const SemiGlobalMatch& out) {
  const Size size = in.left.size();
  DUO_CHECK(in.max_disparity >= 1 && in.max_disparity <= 256 && scratch.lanes == SemiGlobalScratch::padding(in.max_disparity));
  DUO_CHECK(out.left.size() == size && out.right.size() == size && out.fine.size() == size);
  DUO_CHECK(static_cast<int>(scratch.rows.size()) >= 2 * pool.threads());
  const int threads = std::min(pool.threads(), size.height);
  for (const bool up : {true, false}) {
    if (up && !in.params.upward) continue;
    for (int y = 0; y < size.height; ++y) scratch.done[static_cast<std::size_t>(y)].store(0, std::memory_order_relaxed);
    const auto run = HWY_DYNAMIC_DISPATCH(sweep);
    pool.rows(pool.threads(), [&](int begin, int, int) {
      if (begin < threads) run(in, scratch, out, begin, threads, up);
    });
  }
}

}  // namespace simd
}  // namespace duo
#endif
