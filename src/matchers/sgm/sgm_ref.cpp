#include "matchers/sgm/sgm.h"

#include <algorithm>

#include "stages/balance/balance.h"
#include "stages/bilateral/bilateral.h"
#include "stages/blur/blur.h"
#include "stages/check_left_right/check_left_right.h"
#include "stages/lucas_kanade/lucas_kanade.h"
#include "stages/match_planes/match_planes.h"
#include "stages/noise/noise.h"

namespace duo::ref {

Sgm::Sgm(const SgmParams& params, const MatchSetup& setup)
    : params_(params),
      max_disparity_(setup.max_disparity),
      denoised_(setup.denoised),
      stream_(setup.stream),
      maps_(setup.size),
      left_(setup.size, 0),
      right_(setup.size, 0) {}

void Sgm::match(const GrayPair& pair, const Match& out, StageTimer& timer, std::optional<bool> clear) {
  const Measured measured = measure(pair, timer, clear);
  GrayPair balanced = pair;
  balanced.right = measured.right;
  match_measured(balanced, measured, max_disparity_, 1, out, timer);
}

Measured Sgm::measure(const GrayPair& pair, StageTimer& timer, std::optional<bool> clear) {
  const int noise_q4 = std::max(ref::noise_q4(pair.left, pair.right), noise_of_coding_q4(pair.coding_noise_q4));
  timer.stage("noise");
  clear_ = clear ? *clear : stream_->next(pair.turn, looks_clear(params_, noise_q4, ref::blur_q4(pair.left, pair.right)));
  timer.stage("blur");
  ref::balance(pair, max_disparity_, clear_ ? kClearUnbalanced : 0, maps_.balanced);
  timer.stage("balance");
  return {maps_.balanced, noise_q4, clear_};
}

void Sgm::match_measured(const GrayPair& pair, const Measured& measured, int max_disparity, int row_step, const Match& wanted,
                         StageTimer& timer) {
  clear_ = measured.clear;
  even_ = is_even(params_, denoised_) && !clear_;
  const Match out{each_row(wanted.d_q4, row_step), each_row(wanted.confidence, row_step)};
  const auto of_size = [size = out.d_q4.size()](auto& image) { return image.view().crop(0, 0, size); };
  const auto left_winner = of_size(maps_.left_winner), right_winner = of_size(maps_.right_winner);
  const auto softened = maps_.softened.view().crop(0, 0, pair.size());
  const auto fine = of_size(maps_.fine);
  const auto thin = [row_step](auto map) { return each_row(map, row_step); };
  left_.size = right_.size = pair.size();
  const int noise_q4 = params_.soften != 0 ? measured.noise_q4 : 0;
  const auto planes = [&](View<const std::uint8_t> gray, View<const std::uint8_t> inside, PlaneImages& out) {
    if (noise_q4 > 0) ref::bilateral(gray, bilateral_range(noise_q4), softened);
    timer.stage("bilateral");
    ref::match_planes(noise_q4 > 0 ? View<const std::uint8_t>(softened) : gray, inside, census_dead_zone(noise_q4), clear_,
                      out);
    timer.stage("match_planes");
  };
  planes(pair.left, pair.left_inside, left_);
  planes(pair.right, pair.right_inside, right_);
  const SemiGlobal in{thin(left_.planes()), thin(right_.planes()), max_disparity, params_.semi_global(even_)};
  ref::semi_global(in, {left_winner, right_winner, fine, out.confidence});
  timer.stage("semi_global");
  // What follows the check writes to another image than it reads: the check stays in the one from which it ends in d_q4.
  const bool refine = refines(params_, pair.masked()) && !clear_;
  const View<std::uint16_t> smoothed = refine ? fine : out.d_q4, before = refine ? out.d_q4 : fine,
                            checked = params_.smooth != 0 ? before : smoothed;
  ref::check_left_right(
      {left_winner, right_winner, thin(pair.left_inside), thin(pair.right_inside), params_.tolerance, params_.reach}, fine,
      checked);
  timer.stage("check_left_right");
  ref::remove_speckle(checked, params_.speckle_step_q4, params_.speckle / row_step);
  timer.stage("speckle");
  if (params_.smooth != 0) ref::weighted_median({checked, in.left.value[0]}, smoothed);
  timer.stage("weighted_median");
  if (refine) ref::lucas_kanade({in.left.value[0], in.right.value[0], smoothed, max_disparity}, out.d_q4);
  timer.stage("lucas_kanade");
  Image<std::uint16_t> columns(out.confidence.empty() ? Size{} : Size{out.d_q4.width(), 2});
  for (int y = 0; y < out.confidence.height(); ++y) keep_confidence(out.d_q4, y, columns, out.confidence);
  for (int y = 0; y < pair.size().height; ++y)
    if (y % row_step != 0) fill_between(left_.planes().value[0], row_step, y, wanted);
  timer.stage("keep_confidence");
}

}  // namespace duo::ref
