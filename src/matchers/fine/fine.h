// The fine matcher: slanted planes over the costs and path sums of semi-global matching. README.md beside this file tells the
// method.
#pragma once

#include <functional>

#include "core/clock.h"
#include "core/pool.h"
#include "matchers/fine/fine_params.h"
#include "matchers/match.h"
#include "matchers/sgm/sgm.h"
#include "stages/fill_regions/fill_regions.h"
#include "stages/semi_global/energy_volume.h"
#include "stages/slanted_planes/slanted_planes.h"
#include "stages/types/gray_pair.h"

namespace duo {

/// The pair seen in a mirror, so that its right view is the left one.
class MirroredPair {
 public:
  /// Without memory for inside pictures where there are none.
  MirroredPair(Size size, bool masked);
  GrayPair of(const GrayPair& pair);

 private:
  Image<std::uint8_t> left_, right_, left_inside_, right_inside_;
  Image<Rgb8> left_color_, right_color_;
};

inline constexpr int kFineMedian = 4;  // px, radius of the median of what was measured

/// The maps between the stages of one frame.
struct FineMaps {
  Disparity whole;  // of sgm, filled; later of the left view, filled
  Image<std::uint16_t> unfilled, median;
  Image<std::uint8_t> holes;
  PlaneMap left, mirrored;
  FineMaps(Size size);
};

/// Ends the stages of a frame, for the timer and for who waits for the frame.
class FineStages {
 public:
  FineStages(StageTimer& timer_, const std::function<void(double)>& progress) : timer(timer_), progress_(progress) {}
  /// `percent`: about its share of the frame's time.
  void end(const char* stage, int percent) {
    timer.stage(stage);
    percent_ += percent;
    if (progress_) progress_(percent_ / 100.0);
  }
  StageTimer& timer;

 private:
  const std::function<void(double)>& progress_;
  int percent_ = 0;
};

/// Disparities of the left view's planes where the planes of the mirrored view agree: at the pixel that a plane leads to, which
/// must lie in the picture and be inside, as the left one, they differ by at most `tolerance` px.
///
/// Shape  all H x W; inside pictures of the pair
/// Units  d_q4 in 1/16 px
void check_planes(const GrayPair& pair, const PlaneMap& left, const PlaneMap& mirrored, int tolerance,
                  View<std::uint16_t> d_q4);

/// Takes back the vote where the right view's border cuts off what the left one sees: there nothing was measured on one side,
/// and lines from the other side's surfaces (stages/fill) are all that is known.
///
/// Shape  all H x W
/// Units  1/16 px
void keep_margin(View<const std::uint16_t> lines, View<std::uint16_t> voted);

namespace ref {

class Fine {
 public:
  Fine(const FineParams& params, const MatchSetup& setup);
  /// Disparity of the left picture in 1/16 px, and what its holes would have.
  ///
  /// Shape   pair as set up with its colours, out the same size
  /// Errors  none
  void match(const GrayPair& pair, const Match& out, StageTimer& timer);

 private:
  void view(const GrayPair& pair, Sgm& sgm, std::optional<bool> clear, PlaneMap& planes, FineStages& stages);
  void fill(const GrayPair& pair);

  FineParams params_;
  int max_disparity_;
  std::function<void(double)> progress_;
  Sgm sgm_, mirrored_sgm_;
  MirroredPair mirrored_;
  FineMaps maps_;
};

}  // namespace ref

namespace simd {

class Fine {
 public:
  Fine(Pool& pool, const FineParams& params, const MatchSetup& setup);
  /// The same; all rows are computed.
  void match(const GrayPair& pair, const Match& out, StageTimer& timer, RowBand rows = {});

 private:
  void view(const GrayPair& pair, Sgm& sgm, std::optional<bool> clear, PlaneMap& planes, FineStages& stages);
  void fill(const GrayPair& pair);

  Pool& pool_;
  FineParams params_;
  int max_disparity_;
  std::function<void(double)> progress_;
  Sgm sgm_, mirrored_sgm_;
  MirroredPair mirrored_;
  FineMaps maps_;
  EnergyVolume energies_;
  EnergyVolumeScratch energies_scratch_;
  SlantedPlanesScratch planes_scratch_;
  FillRegionsScratch regions_scratch_;
  SpeckleScratch speckle_scratch_;
  LucasKanadeScratch last_scratch_;
};

}  // namespace simd

namespace vk {
class Fine;
}

/// As matchers/matcher_list.h wants it.
struct FineMatcher {
  static constexpr std::string_view kName = "fine";
  static constexpr std::span<const std::string_view> kPresets = kFinePresets;
  static constexpr std::span<const Parameter<FineParams>> kParameters = kFineParameters;
  static constexpr int kMaxDisparity = FineParams::kMaxDisparity;
  static constexpr bool kTellsConfidence = false;
  static constexpr bool kTakesColor = true, kFills = true;
  using Params = FineParams;
  static Result<Params> params(std::string_view preset, const Overrides& overrides) { return fine_params(preset, overrides); }
  using Ref = ref::Fine;
  using Simd = simd::Fine;
  using Vulkan = vk::Fine;
};

}  // namespace duo
