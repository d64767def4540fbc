#include "matchers/pyramid/pyramid.h"

#include <utility>

#include "stages/check_left_right/check_left_right.h"
#include "stages/halve/halve.h"
#include "stages/mark_invalid/mark_invalid.h"
#include "stages/median/median.h"
#include "stages/tile_candidates/tile_candidates.h"

namespace duo::simd {

Pyramid::Pyramid(Pool& pool, const PyramidParams& params, const MatchSetup& setup)
    : pool_(pool),
      params_(params),
      levels_(make_levels(params, setup)),
      filtered_(setup.size),
      balanced_(params.balance != 0 ? setup.size : Size{}),
      balance_scratch_(balanced_.size()),
      speckle_scratch_(setup.size) {
  for (const PyramidLevel& level : levels_)
    if (params.search == PyramidParams::Search::kAround)
      around_scratch_.emplace_back(level.size);
    else
      tiles_scratch_.emplace_back(level.size, level.max_disparity, pool.threads());
}

void Pyramid::match(const GrayPair& pair, const Match& out, StageTimer& timer, RowBand) {
  const Measured measured = measure(pair, timer);
  GrayPair balanced = pair;
  balanced.right = measured.right;
  match_measured(balanced, measured, out, timer);
}

Measured Pyramid::measure(const GrayPair& pair, StageTimer& timer) {
  if (params_.balance == 0) return {pair.right};
  simd::balance(pool_, pair, levels_[0].max_disparity, 0, balance_scratch_, balanced_);
  timer.stage("balance");
  return {balanced_};
}

void Pyramid::match_measured(const GrayPair& pair, const Measured&, const Match& out, StageTimer& timer) {
  for (int i = 1; i < params_.levels; ++i) {
    const GrayPair finer = pair_of(pair, i - 1);
    PyramidLevel& level = levels_[static_cast<std::size_t>(i)];
    simd::halve(pool_, finer.left, level.left);
    simd::halve(pool_, finer.right, level.right);
    if (pair.masked()) {
      simd::halve_inside(pool_, finer.left_inside, level.left_inside);
      simd::halve_inside(pool_, finer.right_inside, level.right_inside);
    }
  }
  timer.stage("halve");
  params_.search == PyramidParams::Search::kAround ? match_around(pair, out.d_q4, timer) : match_tiles(pair, out.d_q4, timer);
}

void Pyramid::match_around(const GrayPair& pair, View<std::uint16_t> d_q4, StageTimer& timer) {
  View<const std::int16_t> coarser;
  for (int i = params_.levels - 1; i >= 0; --i) {
    const GrayPair here = pair_of(pair, i);
    PyramidLevel& level = levels_[static_cast<std::size_t>(i)];
    const MatchAround in{here.left, here.right, here.left_inside, here.right_inside, coarser, radius_of(params_, i)};
    simd::match_around(pool_, in, around_scratch_[static_cast<std::size_t>(i)], level.left_winner);
    coarser = level.left_winner;
  }
  timer.stage("match_around");
  simd::mark_invalid(pool_, coarser, pair.left_inside, pair.right_inside, levels_[0].max_disparity, d_q4);
  timer.stage("mark_invalid");
}

void Pyramid::match_tiles(const GrayPair& pair, View<std::uint16_t> d_q4, StageTimer& timer) {
  for (int i = params_.levels - 1; i >= 0; --i) {
    PyramidLevel& level = levels_[static_cast<std::size_t>(i)];
    const MatchTilesParams params{params_.truncation, params_.sobel_clip, i == 0};
    simd::match_tiles(pool_, pair_of(pair, i), level.sets, params, tiles_scratch_[static_cast<std::size_t>(i)],
                      {level.left_winner, level.right_winner, level.fine});
    timer.stage("match_tiles");
    if (i == 0) break;
    const GrayPair here = level.pair();
    simd::check_winners(pool_,
                        {level.left_winner, level.right_winner, here.left_inside, here.right_inside, params_.tolerance, 0},
                        level.checked);
    simd::tile_candidates(pool_, {level.checked, level.left_winner, params_.grow, params_.margin},
                          levels_[static_cast<std::size_t>(i - 1)].sets);
    timer.stage("tile_candidates");
  }
  PyramidLevel& full = levels_[0];
  // Medians go back and forth between two images; the check starts in the one from which the last median ends in d_q4.
  View<std::uint16_t> now = params_.medians % 2 == 0 ? d_q4 : filtered_.view(),
                      next = params_.medians % 2 == 0 ? filtered_.view() : d_q4;
  simd::check_left_right(
      pool_, {full.left_winner, full.right_winner, pair.left_inside, pair.right_inside, params_.tolerance, params_.reach},
      full.fine, now);
  timer.stage("check_left_right");
  for (int i = 0; i < params_.medians; ++i, std::swap(now, next)) simd::median3x3(pool_, now, next);
  timer.stage("median");
  simd::remove_speckle(pool_, d_q4, params_.speckle_step_q4, params_.speckle, speckle_scratch_);
  timer.stage("speckle");
}

}  // namespace duo::simd
