#include "matchers/pyramid/pyramid.h"

#include <utility>

#include "stages/check_left_right/check_left_right.h"
#include "stages/halve/halve.h"
#include "stages/mark_invalid/mark_invalid.h"
#include "stages/median/median.h"
#include "stages/tile_candidates/tile_candidates.h"

namespace duo::ref {

Pyramid::Pyramid(const PyramidParams& params, const MatchSetup& setup)
    : params_(params),
      levels_(make_levels(params, setup)),
      filtered_(setup.size),
      balanced_(params.balance != 0 ? setup.size : Size{}) {}

void Pyramid::match(const GrayPair& pair, const Match& out, StageTimer& timer) {
  const Measured measured = measure(pair, timer);
  GrayPair balanced = pair;
  balanced.right = measured.right;
  match_measured(balanced, measured, out, timer);
}

Measured Pyramid::measure(const GrayPair& pair, StageTimer& timer) {
  if (params_.balance == 0) return {pair.right};
  ref::balance(pair, levels_[0].max_disparity, 0, balanced_);
  timer.stage("balance");
  return {balanced_};
}

void Pyramid::match_measured(const GrayPair& pair, const Measured&, const Match& out, StageTimer& timer) {
  for (int i = 1; i < params_.levels; ++i) {
    const GrayPair finer = pair_of(pair, i - 1);
    PyramidLevel& level = levels_[static_cast<std::size_t>(i)];
    ref::halve(finer.left, level.left);
    ref::halve(finer.right, level.right);
    if (pair.masked()) {
      ref::halve_inside(finer.left_inside, level.left_inside);
      ref::halve_inside(finer.right_inside, level.right_inside);
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
    ref::match_around(in, level.left_winner);
    coarser = level.left_winner;
  }
  timer.stage("match_around");
  ref::mark_invalid(coarser, pair.left_inside, pair.right_inside, levels_[0].max_disparity, d_q4);
  timer.stage("mark_invalid");
}

void Pyramid::match_tiles(const GrayPair& pair, View<std::uint16_t> d_q4, StageTimer& timer) {
  for (int i = params_.levels - 1; i >= 0; --i) {
    PyramidLevel& level = levels_[static_cast<std::size_t>(i)];
    const MatchTilesParams params{params_.truncation, params_.sobel_clip, i == 0};
    ref::match_tiles(pair_of(pair, i), level.sets, params, {level.left_winner, level.right_winner, level.fine});
    timer.stage("match_tiles");
    if (i == 0) break;
    const GrayPair here = level.pair();
    ref::check_winners({level.left_winner, level.right_winner, here.left_inside, here.right_inside, params_.tolerance, 0},
                       level.checked);
    ref::tile_candidates({level.checked, level.left_winner, params_.grow, params_.margin},
                         levels_[static_cast<std::size_t>(i - 1)].sets);
    timer.stage("tile_candidates");
  }
  PyramidLevel& full = levels_[0];
  // Medians go back and forth between two images; the check starts in the one from which the last median ends in d_q4.
  View<std::uint16_t> now = params_.medians % 2 == 0 ? d_q4 : filtered_.view(),
                      next = params_.medians % 2 == 0 ? filtered_.view() : d_q4;
  ref::check_left_right(
      {full.left_winner, full.right_winner, pair.left_inside, pair.right_inside, params_.tolerance, params_.reach}, full.fine,
      now);
  timer.stage("check_left_right");
  for (int i = 0; i < params_.medians; ++i, std::swap(now, next)) ref::median3x3(now, next);
  timer.stage("median");
  ref::remove_speckle(d_q4, params_.speckle_step_q4, params_.speckle);
  timer.stage("speckle");
}

}  // namespace duo::ref
