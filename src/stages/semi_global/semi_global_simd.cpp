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

// Plain C++ for processors without vectors: unrolled, it would be half of this file's compile time.
#if HWY_TARGET == HWY_EMU128 && defined(__GNUC__) && !defined(__clang__)
#pragma GCC push_options
#pragma GCC optimize("O1")
#endif

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

/// The rows of this thread before row `end`, without winners; the next one.
template <Walk kWalk, bool kDiagonals, int kStep>
int walk(const Sweep& sweep, int i, int end) {
  const Part& part = sweep.part;
  for (; i < end; i += part.threads) {
    Along<kWalk, kDiagonals, kStep> along(sweep, i, sweep.s.row(part.thread_of_all, 0));
    for (int from = 0; from < part.width(); from += kBlock) {
      const int to = std::min(from + kBlock, part.width());
      if (i > 0) sweep.wait_for(i - 1, std::min(to + 1, part.width()));
      costs_of_block<kStep>(part, along, from, to);
      for (int p = from; p < to; ++p) along.template pixel<kAnyVectors>(column<kStep>(part, p));
      sweep.finished(i, to);
    }
  }
  return i;
}

/// And the rest, with winners. A thread walks along one row and back along an earlier one at the same time: each pixel of a
/// path waits for the pixel before, and two such chains fill each other's waiting.
template <bool kDiagonals, int kStep, int kVectors>
void walk_and_pick(const Sweep& sweep, int i) {
  const Part& part = sweep.part;
  const int width = part.width(), behind = part.facing != nullptr ? Scratch::kBehind : 1;  // rows of this thread
  const auto row = [&](int turn) -> Scratch::Row& { return sweep.s.row(part.thread_of_all, turn); };
  int turn = 0;
  for (; i < part.count; i += part.threads, ++turn) {
    Along<Walk::kPick, kDiagonals, kStep> along(sweep, i, row(turn));
    const bool both = turn >= behind;
    const int back_i = both ? i - behind * part.threads : 0;
    if (both) sweep.wait_for_facing(back_i);
    Back<-kStep> back(sweep, sweep.y_of(back_i), row(both ? turn - behind : turn), both);
    for (int begin = 0; begin < width; begin += kBlock) {
      const int end = std::min(begin + kBlock, width);
      if (i > 0) sweep.wait_for(i - 1, std::min(end + 1, width));
      costs_of_block<kStep>(part, along, begin, end);
      for (int p = begin; p < end; ++p) {
        along.template pixel<kVectors>(column<kStep>(part, p));
        if (both) back.template pixel<kVectors>(column<kStep>(part, width - 1 - p));
      }
      if (end == width && part.facing != nullptr) along.meet(i);
      sweep.finished(i, end);
    }
    if (both) back.finish();
  }
  for (int left = std::max(0, turn - behind); left < turn; ++left) {
    const int back_i = i - (turn - left) * part.threads;
    sweep.wait_for_facing(back_i);
    Back<-kStep> back(sweep, sweep.y_of(back_i), row(left), true);
    for (int p = width - 1; p >= 0; --p) back.template pixel<kVectors>(column<kStep>(part, p));
    back.finish();
  }
}

template <bool kDiagonals, int kStep>
void run(const Sweep& sweep) {
  const Part& part = sweep.part;
  int i = walk<Walk::kPass, kDiagonals, kStep>(sweep, part.thread, part.passed);
  if constexpr (kStep > 0) {
    i = walk<Walk::kKeep, kDiagonals, kStep>(sweep, i, part.kept);
    sweep.sums_are_there();
    sweep.wait_for_sums();
  }
  // The default's 128 disparities, and with vectors of 32 bytes 97 to 160, of 64 bytes 65 to 192, without loops.
  constexpr int kUsual = std::max(1, 128 / kMostLanes), kMore = kUsual + 1;
  const int vectors = hn::Lanes(D()) == kMostLanes && !sweep.in.params.upward  // vectors of SVE can be shorter
                          ? (sweep.lanes - sweep.first) / kMostLanes
                          : kAnyVectors;
  if (!kDiagonals && vectors == kUsual)
    walk_and_pick<kDiagonals, kStep, kDiagonals ? kAnyVectors : kUsual>(sweep, i);
  else if (!kDiagonals && vectors == kMore && kMostLanes > 16)
    walk_and_pick<kDiagonals, kStep, kDiagonals || kMostLanes <= 16 ? kAnyVectors : kMore>(sweep, i);
  else
    walk_and_pick<kDiagonals, kStep, kAnyVectors>(sweep, i);
}

void sweep(const SemiGlobal& in, Scratch& scratch, const SemiGlobalMatch& out, const Part& part) {
  const Sweep here(in, scratch, out, part);
  if (in.params.diagonals)
    run<true, 1>(here);
  else
    part.begin > 0 ? run<false, -1>(here) : run<false, 1>(here);
}

}  // namespace duo::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_TARGET == HWY_EMU128 && defined(__GNUC__) && !defined(__clang__)
#pragma GCC pop_options
#endif

#if HWY_ONCE
namespace duo {
HWY_EXPORT(sweep);

namespace simd {
namespace {

/// With the best instructions for this processor.
auto best_sweep(const SemiGlobalScratch& scratch)
    -> void (*)(const SemiGlobal&, SemiGlobalScratch&, const SemiGlobalMatch&, const SemiGlobalPart&) {
#if HWY_ARCH_X86 && (HWY_TARGETS & HWY_AVX2)
  if (scratch.half_vectors) return &N_AVX2::sweep;
#endif
  return HWY_DYNAMIC_DISPATCH(sweep);
}

/// Left of the middle a right pixel has candidates in both halves; those of the left one have the smaller d.
void join_right_winners(const SemiGlobal& in, const SemiGlobalScratch& scratch, int middle, View<std::int16_t> right) {
  const RowBand rows = in.rows.within(right.height());
  for (int y = rows.begin; y < rows.end; ++y)
    for (int j = std::max(0, scratch.lanes - middle), x = middle - scratch.lanes + j; x < middle; ++j, ++x)
      if (scratch.right_best.at(y, j) < scratch.left_best.at(y, j)) right.at(y, x) = scratch.right_winner.at(y, j);
}

/// One of two teams, each with memory of its own; `thread` of all.
SemiGlobalPart of_team(SemiGlobalScratch& scratch, int thread, int team, int teams_threads, int rings_before, int height) {
  SemiGlobalPart part;
  part.thread = thread / 2;
  part.threads = teams_threads;
  part.thread_of_all = thread;
  part.ring = rings_before;
  part.done = &scratch.done[static_cast<std::size_t>(team * height)];
  return part;
}

/// Of an even number of threads, half sweep down and half up, and keep their sums; where they meet, each takes those of the
/// others and picks winners in the rest.
SemiGlobalPart meeting_sweep(SemiGlobalScratch& scratch, int thread, int threads, Size size) {
  const int team = thread % 2, half = threads / 2;
  SemiGlobalPart part = of_team(scratch, thread, team, half, team * (half + 1), size.height);
  part.up = team == 1;
  part.kept = part.up ? size.height - size.height / 2 : size.height / 2;
  part.count = size.height;
  part.end = size.width;
  part.sums = &scratch.sums[static_cast<std::size_t>(team)];
  part.sums_of_others = &scratch.sums[static_cast<std::size_t>(1 - team)];
  return part;
}

/// Half of the threads has the left half of all columns, half the right one.
SemiGlobalPart half_of_columns(SemiGlobalScratch& scratch, int thread, int threads, int middle, Size size, RowBand rows) {
  const int team = thread % 2, left = (threads + 1) / 2;
  SemiGlobalPart part = of_team(scratch, thread, team, team == 0 ? left : threads - left, team * (left + 1), size.height);
  part.passed = part.kept = rows.begin;
  part.count = rows.end;
  part.begin = team == 0 ? 0 : middle;
  part.end = team == 0 ? middle : size.width;
  part.facing = &scratch.done[static_cast<std::size_t>((1 - team) * size.height)];
  part.facing_width = size.width - part.width();
  return part;
}

/// All threads take the rows of one sweep in turn. Up: all that is kept is sums.
SemiGlobalPart row_in_turn(SemiGlobalScratch& scratch, int thread, int threads, bool up, Size size, RowBand rows) {
  SemiGlobalPart part;
  part.up = up;
  part.passed = up ? size.height - rows.end : rows.begin;
  part.count = up ? size.height - rows.begin : rows.end;
  part.kept = up ? part.count : part.passed;
  part.end = size.width;
  part.thread = part.thread_of_all = thread;
  part.threads = threads;
  part.done = scratch.done.get();
  return part;
}

}  // namespace

bool SemiGlobalScratch::prefers_half_vectors() {
#if HWY_ARCH_X86 && (HWY_TARGETS & HWY_AVX2)
  if (__builtin_cpu_is("amd") == 0) return false;
  const std::int64_t targets = hwy::SupportedTargets();
  hwy::GetChosenTarget().Update(targets);  // the question lets all instructions in again, also those that somebody disabled
  return (targets & HWY_AVX2) != 0;
#else
  return false;
#endif
}

void semi_global(Pool& pool, const SemiGlobal& in, SemiGlobalScratch& scratch, const SemiGlobalMatch& out) {
  const Size size = in.left.size();
  DUO_CHECK(in.max_disparity >= 1 && in.max_disparity <= 256);
  scratch.fit(size, in.max_disparity);
  DUO_CHECK(out.left.size() == size && out.right.size() == size && out.fine.size() == size);
  DUO_CHECK(static_cast<int>(scratch.rows.size()) >= scratch.rows_each * pool.threads());
  const int threads = std::min(pool.threads(), size.height);
  const auto run = [&](const auto& part_of) {
    for (int i = 0; i < 2 * size.height; ++i) scratch.done[static_cast<std::size_t>(i)].store(0, std::memory_order_relaxed);
    for (std::size_t team : {0, 1}) scratch.sums[team].store(0, std::memory_order_relaxed);
    const auto here = best_sweep(scratch);
    pool.rows(pool.threads(), [&](int thread, int, int) {
      if (thread < threads) here(in, scratch, out, part_of(thread));
    });
  };
  const RowBand rows = in.rows.within(size.height);
  const bool whole = rows.begin == 0 && rows.end == size.height;
  if (in.params.upward && whole && threads % 2 == 0)
    return run([&](int thread) { return meeting_sweep(scratch, thread, threads, size); });
  if (!in.params.upward && !in.params.diagonals && threads > 1 && size.width > 1) {
    const int middle = std::clamp(size.width * ((threads + 1) / 2) / threads, 1, size.width - 1);
    run([&](int thread) { return half_of_columns(scratch, thread, threads, middle, size, rows); });
    return join_right_winners(in, scratch, middle, out.right);
  }
  for (const bool up : {true, false})
    if (!up || in.params.upward) run([&](int thread) { return row_in_turn(scratch, thread, threads, up, size, rows); });
}

}  // namespace simd
}  // namespace duo
#endif
