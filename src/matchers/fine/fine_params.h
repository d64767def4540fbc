// Parameters of the fine matcher and its presets.
#pragma once

#include <string_view>

#include "core/parameter.h"
#include "matchers/sgm/sgm_params.h"

namespace duo {

struct FineParams {
  // Those of sgm mean the same here.
  int soften = SgmParams{}.soften, clear = SgmParams{}.clear, speckle = SgmParams{}.speckle;
  int tolerance = 1;
  int smooth = 1;

  static constexpr int kMaxDisparity = SgmParams::kMaxDisparity;
  SgmParams sgm() const;
};

inline constexpr Parameter<FineParams> kFineParameters[] = {
    {"soften", &FineParams::soften, "", 0, 1,
     "noisy pictures are smoothed before matching, by what is measured of their noise: 1 on, 0 off"},
    {"clear", &FineParams::clear, "", 0, 2,
     "whole gradients, for pictures that are finely resolved and without noise: 0 never, 1 where they are measured to be, 2 "
     "always"},
    {"tolerance", &FineParams::tolerance, "px", 0, 4, "check of both views' planes: difference allowed"},
    {"speckle", &FineParams::speckle, "px", 0, 10000, "islands of fewer pixels are removed"},
    {"smooth", &FineParams::smooth, "", 0, 1, "weighted median guided by colours: 1 on, 0 off"},
};

/// "fine" is the default under the name by which --preset finds this matcher.
inline constexpr std::string_view kFinePresets[] = {"default", "fine"};

/// The parameters of a preset with some of them overridden.
///
/// Errors  unknown preset or name, value out of range or not whole: with what is allowed
Result<FineParams> fine_params(std::string_view preset, const Overrides& overrides);

}  // namespace duo
