// The semi-global matcher: census and gradient costs, aggregated along paths. README.md beside this file tells the method.
#pragma once

#include <optional>

#include "core/clock.h"
#include "core/pool.h"
#include "matchers/match.h"
#include "matchers/sgm/keep_confidence_params.h"
#include "matchers/sgm/sgm_params.h"
#include "stages/balance/balance.h"
#include "stages/lucas_kanade/lucas_kanade.h"
#include "stages/speckle/speckle.h"
#include "stages/types/gray_pair.h"
#include "stages/types/match_planes.h"
#include "stages/weighted_median/weighted_median.h"

namespace duo {

/// The maps between the stages of one frame.
struct SgmMaps {
  Image<std::uint8_t> balanced, softened;
  Image<std::int16_t> left_winner, right_winner;
  Image<std::uint16_t> fine;
  SgmMaps(Size size) : balanced(size), softened(size), left_winner(size), right_winner(size), fine(size) {}
};

/// Whether a pair looks clear by what was measured of it, or by what the parameters ask for.
bool looks_clear(const SgmParams& params, int noise_q4, int blur_q4);

/// Whether the last fraction is looked for in pictures that are not clear. By itself only in those that were rectified here
/// (`masked`): of pictures that come rectified it is not known what lies between camera and matcher, and half a pixel was
/// exceeded on 7.0 instead of 4.5 % of cones.
bool refines(const SgmParams& params, bool masked);

/// Whether P2 is the same at all steps of gray in pictures that are not clear. By itself only in those that were denoised here:
/// smoothing spreads the step at a surface's end over several pixels, so that the steps left between neighbours are texture,
/// stripes above all, and paths that may change surface there at less cost go astray. Noisy pictures that are matched as they
/// come have their steps: bad-1.0 with noise of sigma 4 is 0.2 to 0.4 points worse without them.
bool is_even(const SgmParams& params, bool denoised);

/// Row y of margins becomes one of confidences: confidence_of() by what disparities differ in 7x7 pixels, holes aside; 0 where
/// there is no disparity. A margin says which surfaces are there, and not on which of them a pixel beside a step lies.
/// `columns`: scratch, two rows as wide as the picture.
void keep_confidence(View<const std::uint16_t> d_q4, int y, View<std::uint16_t> columns, View<std::uint8_t> confidence);

/// Each `step`-th row of a map, from the first one on.
template <class T>
View<T> each_row(View<T> map, int step) {
  return map.empty() ? map : View<T>(map.data(), {map.width(), (map.height() + step - 1) / step}, step * map.stride());
}
MatchPlanes each_row(MatchPlanes planes, int step);

/// Row y, which lies between two that were matched, each `step`-th from 0 on: their mean where both lie on one surface, within
/// a pixel of disparity; else what the one has, holes too, whose gray value is closer, the upper one of equals. Below the last
/// matched row what that has. A confidence is the smaller one of a mean's, else that of the row taken.
void fill_between(View<const std::uint8_t> gray, int step, int y, const Match& out);

namespace ref {

class Sgm {
 public:
  Sgm(const SgmParams& params, const MatchSetup& setup);
  /// Disparity of the left picture in 1/16 px. Confidence: the margin by which the winner's cost beats all disparities beside
  /// its neighbours, less where the disparity changes (keep_confidence()). Sure pixels are right more often (tested), how often
  /// depends on the scene.
  ///
  /// Shape   pair as set up, out the same size
  /// Errors  none, and no allocation but in the reference's stages
  ///
  /// `clear`: how the pair is matched where that has been settled; else its stream settles it
  void match(const GrayPair& pair, const Match& out, StageTimer& timer, std::optional<bool> clear = {});
  /// Its first step, and all others, of the pair or of a part of it, which may be smaller and is searched for [0,
  /// max_disparity), at most as set up: `pair.right` is cut from `measured.right`. Each `row_step`-th row is matched, as if
  /// there were no others, but for what rows beside it bring to a pixel's costs.
  Measured measure(const GrayPair& pair, StageTimer& timer, std::optional<bool> clear = {});
  void match_measured(const GrayPair& pair, const Measured& measured, int max_disparity, int row_step, const Match& out,
                      StageTimer& timer);
  /// Of the last whole pair: what was compared, and whether as clear pictures.
  SemiGlobal compared() const { return {left_.planes(), right_.planes(), max_disparity_, params_.semi_global(even_)}; }
  bool clear() const { return clear_; }

 private:
  SgmParams params_;
  int max_disparity_;
  bool denoised_;
  std::shared_ptr<ClearStream> stream_;
  bool clear_ = false, even_ = false;  // of the last pair
  SgmMaps maps_;
  PlaneImages left_, right_;
};

}  // namespace ref

namespace simd {

class Sgm {
 public:
  Sgm(Pool& pool, const SgmParams& params, const MatchSetup& setup);
  /// The same in `rows`; none in all others. Saves most of what these would take.
  void match(const GrayPair& pair, const Match& out, StageTimer& timer, RowBand rows = {}, std::optional<bool> clear = {});
  Measured measure(const GrayPair& pair, StageTimer& timer, std::optional<bool> clear = {});
  void match_measured(const GrayPair& pair, const Measured& measured, int max_disparity, int row_step, const Match& out,
                      StageTimer& timer, RowBand rows = {});
  SemiGlobal compared() const { return {left_.planes(), right_.planes(), max_disparity_, params_.semi_global(even_)}; }
  bool clear() const { return clear_; }

 private:
  Pool& pool_;
  SgmParams params_;
  int max_disparity_;
  bool denoised_;
  std::shared_ptr<ClearStream> stream_;
  bool clear_ = false, even_ = false;  // of the last pair
  SgmMaps maps_;
  PlaneImages left_, right_;
  BalanceScratch balance_scratch_;
  SemiGlobalScratch scratch_;
  SpeckleScratch speckle_scratch_;
  WeightedMedianScratch smooth_scratch_;
  LucasKanadeScratch refine_scratch_;
  Image<std::uint16_t> columns_;  // two rows a thread: keep_confidence()
};

}  // namespace simd

namespace vk {
class Sgm;
}

/// As matchers/matcher_list.h wants it.
struct SgmMatcher {
  static constexpr std::string_view kName = "sgm";
  static constexpr std::span<const std::string_view> kPresets = kSgmPresets;
  static constexpr std::span<const Parameter<SgmParams>> kParameters = kSgmParameters;
  static constexpr int kMaxDisparity = SgmParams::kMaxDisparity;
  static constexpr bool kTellsConfidence = true;
  static constexpr bool kTakesColor = false, kFills = false;
  using Params = SgmParams;
  static Result<Params> params(std::string_view preset, const Overrides& overrides) { return sgm_params(preset, overrides); }
  using Ref = ref::Sgm;
  using Simd = simd::Sgm;
  using Vulkan = vk::Sgm;
};

}  // namespace duo
