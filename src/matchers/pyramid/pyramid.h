// The pyramid matcher: coarse-to-fine window matching with Birchfield-Tomasi costs. README.md beside this file tells the
// method.
#pragma once

#include <vector>

#include "core/clock.h"
#include "core/pool.h"
#include "core/row_band.h"
#include "duoptic/engine.h"
#include "matchers/match.h"
#include "matchers/pyramid/pyramid_params.h"
#include "stages/balance/balance.h"
#include "stages/match_around/match_around.h"
#include "stages/match_tiles/match_tiles.h"
#include "stages/speckle/speckle.h"
#include "stages/types/gray_pair.h"
#include "stages/types/tile_sets.h"

namespace duo {

/// Size and search range of each level; level 0 is the full picture.
struct LevelShape {
  Size size;
  int max_disparity = 0;
};
std::vector<LevelShape> level_shapes(const PyramidParams& params, const MatchSetup& setup);

/// The memory of one level; level 0 is the full picture, which belongs to the caller.
struct PyramidLevel {
  Size size;
  int max_disparity = 0;
  Image<std::uint8_t> left, right, left_inside, right_inside;
  Image<std::int16_t> left_winner, right_winner, checked;
  Image<std::uint16_t> fine;
  TileSets sets;

  GrayPair pair() const { return {left, right, left_inside, right_inside}; }
};
std::vector<PyramidLevel> make_levels(const PyramidParams& params, const MatchSetup& setup);

/// The thesis's search radius of a level: 2^(n-1) D_T, n counted from 1 at the coarsest, which has none.
int radius_of(const PyramidParams& params, int level);

namespace ref {

class Pyramid {
 public:
  Pyramid(const PyramidParams& params, const MatchSetup& setup);
  /// Disparity of the left picture in 1/16 px; this matcher tells no confidence.
  ///
  /// Shape   pair as set up, out the same size
  /// Errors  none, and no allocation but in the reference's stages
  void match(const GrayPair& pair, const Match& out, StageTimer& timer);
  /// Its first step, and all others, of the pair or of a part of it: `pair.right` is cut from `measured.right`.
  Measured measure(const GrayPair& pair, StageTimer& timer);
  void match_measured(const GrayPair& pair, const Measured& measured, const Match& out, StageTimer& timer);

 private:
  void match_around(const GrayPair& pair, View<std::uint16_t> d_q4, StageTimer& timer);
  void match_tiles(const GrayPair& pair, View<std::uint16_t> d_q4, StageTimer& timer);
  GrayPair pair_of(const GrayPair& full, int level) const {
    return level == 0 ? full : levels_[static_cast<std::size_t>(level)].pair();
  }

  PyramidParams params_;
  std::vector<PyramidLevel> levels_;
  Image<std::uint16_t> filtered_;
  Image<std::uint8_t> balanced_;  // the right picture
};

}  // namespace ref

namespace simd {

class Pyramid {
 public:
  Pyramid(Pool& pool, const PyramidParams& params, const MatchSetup& setup);
  /// The same in all rows, whichever are asked for: coarse levels see far.
  void match(const GrayPair& pair, const Match& out, StageTimer& timer, RowBand rows = {});
  Measured measure(const GrayPair& pair, StageTimer& timer);
  void match_measured(const GrayPair& pair, const Measured& measured, const Match& out, StageTimer& timer);

 private:
  void match_around(const GrayPair& pair, View<std::uint16_t> d_q4, StageTimer& timer);
  void match_tiles(const GrayPair& pair, View<std::uint16_t> d_q4, StageTimer& timer);
  GrayPair pair_of(const GrayPair& full, int level) const {
    return level == 0 ? full : levels_[static_cast<std::size_t>(level)].pair();
  }

  Pool& pool_;
  PyramidParams params_;
  std::vector<PyramidLevel> levels_;
  Image<std::uint16_t> filtered_;
  Image<std::uint8_t> balanced_;  // the right picture
  BalanceScratch balance_scratch_;
  std::vector<MatchAroundScratch> around_scratch_;
  std::vector<MatchTilesScratch> tiles_scratch_;
  SpeckleScratch speckle_scratch_;
};

}  // namespace simd

namespace vk {
class Pyramid;
}

/// As matchers/matcher_list.h wants it.
struct PyramidMatcher {
  static constexpr std::string_view kName = "pyramid";
  static constexpr std::span<const std::string_view> kPresets = kPyramidPresets;
  static constexpr std::span<const Parameter<PyramidParams>> kParameters = kPyramidParameters;
  static constexpr int kMaxDisparity = Engine::kMaxDisparity;
  static constexpr bool kTellsConfidence = false;
  static constexpr bool kTakesColor = false, kFills = false;
  using Params = PyramidParams;
  static Result<Params> params(std::string_view preset, const Overrides& overrides) {
    return pyramid_params(preset, overrides);
  }
  using Ref = ref::Pyramid;
  using Simd = simd::Pyramid;
  using Vulkan = vk::Pyramid;
};

}  // namespace duo
