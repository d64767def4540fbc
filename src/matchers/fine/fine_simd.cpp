#include <algorithm>

#include "core/check.h"
#include "matchers/fine/fine.h"
#include "stages/color_median/color_median.h"
#include "stages/fill/fill.h"
#include "stages/lucas_kanade/lucas_kanade.h"
#include "stages/slanted_planes/plane_fit.h"

namespace duo::simd {

Fine::Fine(Pool& pool, const FineParams& params, const MatchSetup& setup)
    : pool_(pool),
      params_(params),
      max_disparity_(setup.max_disparity),
      progress_(setup.progress),
      sgm_(pool, params.sgm(), setup),
      mirrored_sgm_(pool, params.sgm(), setup),
      mirrored_(setup.size, setup.masked),
      maps_(setup.size),
      energies_(setup.size, setup.max_disparity),
      energies_scratch_(setup.size, setup.max_disparity, pool.most()),
      planes_scratch_(setup.size),
      regions_scratch_(setup.size),
      speckle_scratch_(setup.size),
      last_scratch_(setup.size, pool.most()) {}

void Fine::match(const GrayPair& pair, const Match& out, StageTimer& timer, RowBand) {
  DUO_CHECK(pair.left_color.size() == pair.size() && pair.right_color.size() == pair.size());
  FineStages stages(timer, progress_);
  view(pair, sgm_, {}, maps_.left, stages);
  view(mirrored_.of(pair), mirrored_sgm_, sgm_.clear(), maps_.mirrored, stages);
  const View<std::uint16_t> checked = params_.smooth != 0 ? maps_.median.view() : out.d_q4;
  check_planes(pair, maps_.left, maps_.mirrored, params_.tolerance, checked);
  simd::remove_speckle(pool_, checked, SgmParams{}.speckle_step_q4, params_.speckle, speckle_scratch_);
  if (params_.smooth != 0) simd::color_median(pool_, {checked, pair.left_color, {}, kFineMedian}, out.d_q4);
  stages.end("check_planes", 9);
  if (!sgm_.clear()) {
    const SemiGlobal compared = sgm_.compared();
    for (int y = 0; y < out.d_q4.height(); ++y) std::copy_n(out.d_q4.row(y), out.d_q4.width(), maps_.unfilled.row(y));
    simd::lucas_kanade(pool_, {compared.left.value[0], compared.right.value[0], maps_.unfilled, max_disparity_}, last_scratch_,
                       out.d_q4);
  }
  stages.end("lucas_kanade", 1);
  if (out.filled.empty()) return;
  for (int y = 0; y < out.d_q4.height(); ++y) std::copy_n(out.d_q4.row(y), out.d_q4.width(), maps_.whole.d_q4.row(y));
  fill(pair);
  for (int y = 0; y < out.d_q4.height(); ++y)
    for (int x = 0; x < out.d_q4.width(); ++x) maps_.holes.at(y, x) = out.d_q4.at(y, x) == Disparity::kNone;
  simd::color_median(pool_, {maps_.whole.d_q4, pair.left_color, maps_.holes, ColorMedian::kMostRadius}, out.filled);
  keep_margin(maps_.whole.d_q4, out.filled);
  stages.end("vote", 10);
}

/// Its planes, from what sgm finds on.
void Fine::view(const GrayPair& pair, Sgm& sgm, std::optional<bool> clear, PlaneMap& planes, FineStages& stages) {
  sgm.match(pair, {maps_.whole.d_q4}, stages.timer, {}, clear);
  fill(pair);
  simd::fit_planes(pool_, {pair.left_color, maps_.whole.d_q4, max_disparity_}, planes);
  stages.end("fit_planes", 15);
  simd::energy_volume(pool_, sgm.compared(), energies_scratch_, energies_);
  stages.end("energy_volume", 4);
  simd::slanted_planes(pool_, {energies_, pair.left_color}, planes_scratch_, planes);
  stages.end("slanted_planes", 21);
}

void Fine::fill(const GrayPair& pair) {
  simd::mark_measured(pool_, maps_.whole.d_q4, maps_.whole.origin);
  simd::fill_regions(pool_, {pair.left, max_disparity_}, regions_scratch_, maps_.whole.d_q4, maps_.whole.origin);
  maps_.whole.d_q4.swap(maps_.unfilled);
  simd::fill(pool_, maps_.unfilled, max_disparity_, maps_.whole.origin, maps_.whole.d_q4);
}

}  // namespace duo::simd
