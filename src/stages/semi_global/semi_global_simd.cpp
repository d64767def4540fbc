// Lanes are disparities, downwards: lane j is d = lanes - 1 - j, so that the right pixels x - d of a left pixel lie in order in
// memory. One sweep goes down the rows. On its way along a row each pixel's cost is worked out once, the paths from the left
// and from above are brought up to date together, and their sum stays in the cache; on the way back along the row the path from
// the right is added and both views' winners are picked. Nothing but a few rows is kept. Paths from below need a sweep of their
// own before it, which leaves one byte for each pixel and disparity. With diagonal paths threads take rows in turn; a row may
// go on as far as the row before it is done. Without, each of two teams has a half of all rows: they walk from both ends to the
// middle, and back where the other team came from, a few rows later. So neither waits while the other falls a little behind.

#include "core/check.h"
#include "stages/semi_global/semi_global.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "stages/semi_global/semi_global_simd.cpp"
#include <hwy/foreach_target.h>
// After foreach_target.h, as Highway asks.
#include <hwy/cache_control.h>
#include <hwy/highway.h>

#include "stages/semi_global/semi_global_back-inl.h"

HWY_BEFORE_NAMESPACE();
namespace duo::HWY_NAMESPACE {

/// Columns by when a walk comes to them.
template <int kStep>
int column(const Part& part, int pixel) {
  return kStep > 0 ? part.begin + pixel : part.end - 1 - pixel;
}
template <int kStep, class A>
void costs_of_block(const Part& part, A& along, int begin, int end) {
  kStep > 0 ? along.costs(part.begin + begin, part.begin + end) : along.costs(part.end - end, part.end - begin);
}

template <bool kDiagonals, int kStep>
void pass(const Sweep& sweep, int i, Scratch::Row& row) {
  const Part& part = sweep.part;
  Along<Walk::kPassing, kDiagonals, kStep> along(sweep, i, row);
  for (int begin = 0; begin < part.width(); begin += kBlock) {
    const int end = std::min(begin + kBlock, part.width());
    if (i > 0) sweep.wait_for(i - 1, std::min(end + 1, part.width()));
    costs_of_block<kStep>(part, along, begin, end);
    for (int p = begin; p < end; ++p) along.pixel(column<kStep>(part, p));
    sweep.finished(i, end);
  }
}

/// A thread walks along one row and back along an earlier one at the same time: each pixel of a path waits for the pixel
/// before, and two such chains fill each other's waiting.
template <bool kUp, bool kDiagonals, int kStep>
void run(const Sweep& sweep) {
  const Part& part = sweep.part;
  const int width = part.width(), behind = part.facing != nullptr ? Scratch::kBehind : 1;  // rows of this thread
  const auto row = [&](int turn) -> Scratch::Row& { return sweep.s.row(part.thread_of_all, turn); };
  int i = part.thread, turn = 0;
  for (; i < sweep.passed; i += part.threads) pass<kDiagonals, kStep>(sweep, i, row(0));
  for (; i < sweep.count; i += part.threads, ++turn) {
    Along<kUp ? Walk::kUp : Walk::kDown, kDiagonals, kStep> along(sweep, i, row(turn));
    const bool both = !kUp && turn >= behind;
    const int back_i = both ? i - behind * part.threads : 0;
    if (both) sweep.wait_for_facing(back_i);
    Back<-kStep> back(sweep, back_i, row(both ? turn - behind : turn), both);
    for (int begin = 0; begin < width; begin += kBlock) {
      const int end = std::min(begin + kBlock, width);
      if (i > 0) sweep.wait_for(i - 1, std::min(end + 1, width));
      costs_of_block<kStep>(part, along, begin, end);
      for (int p = begin; p < end; ++p) {
        along.pixel(column<kStep>(part, p));
        if (both) back.pixel(column<kStep>(part, width - 1 - p));
      }
      if (!kUp && end == width && part.facing != nullptr) along.meet(i);
      sweep.finished(i, end);
    }
    if (both) back.finish();
  }
  if (kUp) return hwy::FlushStream();
  for (int left = std::max(0, turn - behind); left < turn; ++left) {
    const int back_i = i - (turn - left) * part.threads;
    sweep.wait_for_facing(back_i);
    Back<-kStep> back(sweep, back_i, row(left), true);
    for (int p = width - 1; p >= 0; --p) back.pixel(column<kStep>(part, p));
    back.finish();
  }
}

void sweep(const SemiGlobal& in, Scratch& scratch, const SemiGlobalMatch& out, const Part& part, bool up) {
  const Sweep here(in, scratch, out, part, up);
  const bool from_right = part.begin > 0;
  if (in.params.diagonals)
    up ? run<true, true, 1>(here) : run<false, true, 1>(here);
  else if (from_right)
    up ? run<true, false, -1>(here) : run<false, false, -1>(here);
  else
    up ? run<true, false, 1>(here) : run<false, false, 1>(here);
}

}  // namespace duo::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace duo {
HWY_EXPORT(sweep);

namespace simd {
namespace {

/// Left of the middle a right pixel has candidates in both halves; those of the left one have the smaller d.
void join_right_winners(const SemiGlobal& in, const SemiGlobalScratch& scratch, int middle, View<std::int16_t> right) {
  const RowBand rows = in.rows.within(right.height());
  for (int y = rows.begin; y < rows.end; ++y)
    for (int j = std::max(0, scratch.lanes - middle), x = middle - scratch.lanes + j; x < middle; ++j, ++x)
      if (scratch.right_best.at(y, j) < scratch.left_best.at(y, j)) right.at(y, x) = scratch.right_winner.at(y, j);
}

}  // namespace

void semi_global(Pool& pool, const SemiGlobal& in, SemiGlobalScratch& scratch, const SemiGlobalMatch& out) {
  const Size size = in.left.size();
  DUO_CHECK(in.max_disparity >= 1 && in.max_disparity <= 256 && scratch.lanes == SemiGlobalScratch::padding(in.max_disparity));
  DUO_CHECK(out.left.size() == size && out.right.size() == size && out.fine.size() == size);
  DUO_CHECK(static_cast<int>(scratch.rows.size()) >= scratch.rows_each * pool.threads());
  const int threads = std::min(pool.threads(), size.height);
  const bool halves = threads > 1 && size.width > 1 && !in.params.diagonals;
  const int left_threads = halves ? (threads + 1) / 2 : threads;
  const int middle = halves ? std::clamp(size.width * left_threads / threads, 1, size.width - 1) : size.width;
  for (const bool up : {true, false}) {
    if (up && !in.params.upward) continue;
    std::atomic<int>*const done = scratch.done.get(), *const done_right = done + size.height;
    for (int i = 0; i < 2 * size.height; ++i) done[i].store(0, std::memory_order_relaxed);
    const auto run = HWY_DYNAMIC_DISPATCH(sweep);
    pool.rows(pool.threads(), [&](int thread, int, int) {
      if (thread >= threads) return;
      const bool right = halves && thread % 2 == 1;
      SemiGlobalPart part{right ? middle : 0, right ? size.width : middle};
      part.thread = halves ? thread / 2 : thread;
      part.threads = right ? threads - left_threads : left_threads;
      part.thread_of_all = thread;
      part.done = right ? done_right : done;
      if (halves) part.facing = right ? done : done_right, part.facing_width = size.width - part.width();
      run(in, scratch, out, part, up);
    });
  }
  if (halves) join_right_winners(in, scratch, middle, out.right);
}

}  // namespace simd
}  // namespace duo
#endif
