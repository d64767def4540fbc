// Parameters of the semi-global matcher and its presets.
#pragma once

#include <string_view>

#include "core/parameter.h"
#include "stages/semi_global/semi_global.h"

namespace duo {

struct SgmParams {
  int paths = 3;
  int soften = 1;
  int clear = 1;
  // The stage's defaults are this matcher's.
  int census_truncation = SemiGlobalParams{}.census_truncation, truncation = SemiGlobalParams{}.truncation;
  int p1 = SemiGlobalParams{}.p1, p2 = SemiGlobalParams{}.p2, p2_least = SemiGlobalParams{}.p2_least;
  int p2_gradient = SemiGlobalParams{}.p2_gradient;
  int even = 1;
  int tolerance = 1;
  int reach = 1;
  int speckle = 60;
  int speckle_step_q4 = 16;
  int smooth = 1;
  int refine = 1;

  static constexpr int kMaxDisparity = 256;
  /// `even`: P2 is the same at all steps of gray.
  SemiGlobalParams semi_global(bool even) const;
};

inline constexpr Parameter<SgmParams> kSgmParameters[] = {
    {"paths", &SgmParams::paths, "", 3, 8, "directions from which costs are summed up: 3, 4, 5 or 8"},
    {"soften", &SgmParams::soften, "", 0, 1,
     "noisy pictures are smoothed before matching, by what is measured of their noise: 1 on, 0 off"},
    {"clear", &SgmParams::clear, "", 0, 2,
     "whole gradients, for pictures that are finely resolved and without noise: 0 never, 1 where they are measured to be, 2 "
     "always"},
    {"census-truncation", &SgmParams::census_truncation, "", 0, 16, "most that the census adds to a pixel's cost"},
    {"truncation", &SgmParams::truncation, "", 0, 32, "most that gray and each gradient add"},
    {"p1", &SgmParams::p1, "", 0, 112, "penalty of a step of one disparity"},
    {"p2", &SgmParams::p2, "", 0, 112, "penalty of a larger step where the picture is flat"},
    {"p2-least", &SgmParams::p2_least, "", 0, 112, "and where it is not, at least"},
    {"p2-gradient", &SgmParams::p2_gradient, "", 1, 255, "gray step that halves p2"},
    {"even", &SgmParams::even, "", 0, 2,
     "p2 the same at all gray steps, in pictures that are not clear: 0 never, as where people are tracked, 1 where they were "
     "denoised here, as raw ones are, 2 always"},
    {"tolerance", &SgmParams::tolerance, "px", 0, 4, "left-right check: difference allowed"},
    {"reach", &SgmParams::reach, "px", 0, 4, "left-right check: columns beside the match that may confirm it"},
    {"speckle", &SgmParams::speckle, "px", 0, 10000, "islands of fewer pixels are removed"},
    {"speckle-step", &SgmParams::speckle_step_q4, "px/16", 1, 256, "neighbours within this difference are one island"},
    {"smooth", &SgmParams::smooth, "", 0, 1, "weighted median guided by the picture: 1 on, 0 off"},
    {"refine", &SgmParams::refine, "", 0, 2,
     "last fraction of a pixel by gray gradients, in pictures that are not clear: 0 never, as where people are tracked, 1 "
     "where they were rectified here from raw ones, 2 always"},
};

inline constexpr std::string_view kSgmPresets[] = {"default", "paths8"};

/// The parameters of a preset with some of them overridden.
///
/// Errors  unknown preset or name, value out of range or not whole, paths that do not exist, p2 below p1: with what is allowed
Result<SgmParams> sgm_params(std::string_view preset, const Overrides& overrides);

}  // namespace duo
