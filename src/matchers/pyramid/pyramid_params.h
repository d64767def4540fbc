// Parameters of the pyramid matcher and its presets.
#pragma once

#include <string_view>

#include "core/parameter.h"
#include "duoptic/result.h"

namespace duo {

struct PyramidParams {
  enum class Search : int {
    kAround,  // the thesis: each pixel around the disparity of the pixel below it
    kTiles,   // each tile tries all that its neighbourhood found below
  };
  Search search = Search::kTiles;
  int balance = 1;
  int levels = 4;
  int d_t_half_px = 3;
  int truncation = 12;
  int sobel_clip = 63;
  int grow = 1;
  int margin = 1;
  int tolerance = 1;
  int reach = 1;
  int medians = 1;
  int speckle = 200;
  int speckle_step_q4 = 16;
};

inline constexpr Parameter<PyramidParams> kPyramidParameters[] = {
    {"balance", &PyramidParams::balance, "", 0, 1, "the right picture's brightness is brought to the left one's: 1 on, 0 off"},
    {"levels", &PyramidParams::levels, "", 1, 4, "levels of the pyramid, the full picture included"},
    {"d-t", &PyramidParams::d_t_half_px, "px/2", 1, 3, "thesis only: D_T, the search radius of level n is 2^(n-1) D_T"},
    {"truncation", &PyramidParams::truncation, "", 1, 12, "most that one channel can add to a pixel's cost"},
    {"sobel-clip", &PyramidParams::sobel_clip, "", 1, 63, "gradients are clipped to this size"},
    {"grow", &PyramidParams::grow, "px", 0, 16, "coarse pixels around a tile whose disparities it tries too"},
    {"margin", &PyramidParams::margin, "px", 0, 4, "disparities tried on both sides of a coarse one"},
    {"tolerance", &PyramidParams::tolerance, "px", 0, 4, "left-right check: difference allowed"},
    {"reach", &PyramidParams::reach, "px", 0, 4, "left-right check: columns beside the match that may confirm it"},
    {"medians", &PyramidParams::medians, "", 0, 4, "3x3 medians of the disparity"},
    {"speckle", &PyramidParams::speckle, "px", 0, 10000, "islands of fewer pixels are removed"},
    {"speckle-step", &PyramidParams::speckle_step_q4, "px/16", 1, 256, "neighbours within this difference are one island"},
};

inline constexpr std::string_view kPyramidPresets[] = {"default", "thesis"};

/// The parameters of a preset with some of them overridden.
///
/// Errors  unknown preset or name, value out of range or not whole: with what is known or allowed
Result<PyramidParams> pyramid_params(std::string_view preset, const Overrides& overrides);

}  // namespace duo
