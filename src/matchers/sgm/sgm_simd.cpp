#include "matchers/sgm/sgm.h"

#include <algorithm>

#include "stages/balance/balance.h"
#include "stages/bilateral/bilateral.h"
#include "stages/blur/blur.h"
#include "stages/check_left_right/check_left_right.h"
#include "stages/lucas_kanade/lucas_kanade.h"
#include "stages/match_planes/match_planes.h"
#include "stages/noise/noise.h"

namespace duo::simd {

Sgm::Sgm(Pool& pool, const SgmParams& params, const MatchSetup& setup)
    : pool_(pool),
      params_(params),
      max_disparity_(setup.max_disparity),
      denoised_(setup.denoised),
      stream_(setup.stream),
      maps_(setup.size),
      left_(setup.size,
            PlaneImages::kPadRight),  // as little as its stage takes: only the right view is looked up beside itself
      right_(setup.size, SemiGlobalScratch::padding(setup.max_disparity)),
      balance_scratch_(setup.size),
      scratch_(setup.size, setup.max_disparity, params.semi_global(false), pool.threads()),
      speckle_scratch_(setup.size),
      smooth_scratch_(setup.size),
      refine_scratch_(setup.size, pool.most()),
      columns_({setup.size.width, 2 * pool.most()}) {}

void Sgm::match(const GrayPair& pair, const Match& out, StageTimer& timer, RowBand rows, std::optional<bool> clear) {
  const Measured measured = measure(pair, timer, clear);
  GrayPair balanced = pair;
  balanced.right = measured.right;
  match_measured(balanced, measured, max_disparity_, 1, out, timer, rows);
}

Measured Sgm::measure(const GrayPair& pair, StageTimer& timer, std::optional<bool> clear) {
  const int noise_q4 = std::max(simd::noise_q4(pool_, pair.left, pair.right), noise_of_coding_q4(pair.coding_noise_q4));
  timer.stage("noise");
  clear_ =
      clear ? *clear : stream_->next(pair.turn, looks_clear(params_, noise_q4, simd::blur_q4(pool_, pair.left, pair.right)));
  timer.stage("blur");
  simd::balance(pool_, pair, max_disparity_, clear_ ? kClearUnbalanced : 0, balance_scratch_, maps_.balanced);
  timer.stage("balance");
  return {maps_.balanced, noise_q4, clear_};
}

void Sgm::match_measured(const GrayPair& pair, const Measured& measured, int max_disparity, int row_step, const Match& asked,
                         StageTimer& timer, RowBand rows) {
  clear_ = measured.clear;
  even_ = is_even(params_, denoised_) && !clear_;
  DUO_CHECK(row_step == 1 || rows.all(pair.size().height));
  const Match out{each_row(asked.d_q4, row_step), each_row(asked.confidence, row_step)};
  const auto of_size = [size = out.d_q4.size()](auto& image) { return image.view().crop(0, 0, size); };
  const auto left_winner = of_size(maps_.left_winner), right_winner = of_size(maps_.right_winner);
  const auto softened = maps_.softened.view().crop(0, 0, pair.size());
  const auto thin = [row_step](auto map) { return each_row(map, row_step); };
  const auto fine = of_size(maps_.fine);
  left_.size = right_.size = pair.size();
  const int noise_q4 = params_.soften != 0 ? measured.noise_q4 : 0;
  // What the result depends on: disparities around a confidence; taps of the last step and of the median; islands, which are
  // smaller than `speckle` pixels where they matter; paths from above, and with paths from below the whole picture.
  const int h = out.d_q4.height();
  const RowBand wanted = rows.within(h);
  rows = out.confidence.empty() ? wanted : wanted.grown(kConfidenceReach, h);
  const bool refine = refines(params_, pair.masked()) && !clear_;
  const RowBand smoothed_rows = refine ? rows.grown(LucasKanade::kRows, h) : rows;
  const RowBand checked_rows = params_.smooth != 0 ? smoothed_rows.grown(WeightedMedian::kRadius, h) : smoothed_rows;
  const int island = params_.speckle / row_step;
  const RowBand joined = checked_rows.grown(island, h);
  const SemiGlobalParams semi_global = params_.semi_global(even_);
  const int plane_rows = semi_global.upward || row_step > 1 ? pair.size().height : joined.end;
  const auto planes = [&](View<const std::uint8_t> gray, View<const std::uint8_t> inside, PlaneImages& out) {
    if (noise_q4 > 0) simd::bilateral(pool_, gray, bilateral_range(noise_q4), softened);
    timer.stage("bilateral");
    simd::match_planes(pool_, noise_q4 > 0 ? View<const std::uint8_t>(softened) : gray, inside, census_dead_zone(noise_q4),
                       clear_, plane_rows, out);
    timer.stage("match_planes");
  };
  planes(pair.left, pair.left_inside, left_);
  planes(pair.right, pair.right_inside, right_);
  const SemiGlobal in{thin(left_.planes()), thin(right_.planes()), max_disparity, semi_global, joined};
  simd::semi_global(pool_, in, scratch_, {left_winner, right_winner, fine, out.confidence});
  timer.stage("semi_global");
  // What follows the check writes to another image than it reads: the check stays in the one from which it ends in d_q4.
  const View<std::uint16_t> smoothed = refine ? fine : out.d_q4, before = refine ? out.d_q4 : fine,
                            checked = params_.smooth != 0 ? before : smoothed;
  simd::check_left_right(
      pool_,
      {joined.of<const std::int16_t>(left_winner), joined.of<const std::int16_t>(right_winner),
       joined.of(thin(pair.left_inside)), joined.of(thin(pair.right_inside)), params_.tolerance, params_.reach},
      joined.of<const std::uint16_t>(fine), joined.of(checked));
  timer.stage("check_left_right");
  simd::remove_speckle(pool_, joined.of(checked), params_.speckle_step_q4, island, speckle_scratch_);
  timer.stage("speckle");
  if (params_.smooth != 0) simd::weighted_median(pool_, {checked, in.left.value[0], smoothed_rows}, smooth_scratch_, smoothed);
  timer.stage("weighted_median");
  if (refine)
    simd::lucas_kanade(pool_, {in.left.value[0], in.right.value[0], smoothed, max_disparity, rows}, refine_scratch_, out.d_q4);
  timer.stage("lucas_kanade");
  if (!out.confidence.empty())
    pool_.rows(wanted.count(), [&](int begin, int end, int part) {
      const View<std::uint16_t> columns = columns_.view().crop(2 * part, 0, {columns_.width(), 2});
      for (int y = wanted.begin + begin; y < wanted.begin + end; ++y) keep_confidence(out.d_q4, y, columns, out.confidence);
    });
  for (int y = 0; y < h; ++y) {
    if (y >= wanted.begin && y < wanted.end) continue;
    std::fill_n(out.d_q4.row(y), out.d_q4.width(), Disparity::kNone);
    if (!out.confidence.empty()) std::fill_n(out.confidence.row(y), out.confidence.width(), std::uint8_t{0});
  }
  timer.stage("keep_confidence");
  if (row_step == 1) return;
  pool_.rows(pair.size().height, [&](int begin, int end) {
    for (int y = begin; y < end; ++y)
      if (y % row_step != 0) fill_between(left_.planes().value[0], row_step, y, asked);
  });
  timer.stage("fill_between");
}

}  // namespace duo::simd
