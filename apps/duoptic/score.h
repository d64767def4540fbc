// Errors of a disparity map against the truth, as the Middlebury evaluation (version 2) counts them.
#pragma once

#include <array>

#include "scene.h"

namespace duo::app {

inline constexpr std::array<float, 3> kThresholdsPx = {0.5f, 1.0f, 2.0f};

/// Shares of bad pixels in per cent: [threshold][region], regions nonocc, all, disc.
using BadPercent = std::array<std::array<double, 3>, 3>;

struct Score {
  BadPercent bad_holes;         // a pixel without disparity counts as bad
  BadPercent bad_filled;        // after fill_rows()
  double average_error_px = 0;  // in all, filled
  double coverage_percent = 0;  // of all, before filling
};

/// Disparity in px as float, negative = none.
///
/// Shape   d_px and the scene's truth the same size
Score score(View<const float> d_px, const Scene& scene);

/// The evaluation's own filling: a hole takes the smaller of the nearest disparities left and right of it on its row.
void fill_rows(View<float> d_px);

/// q4 disparity as float px, negative = none.
Image<float> to_px(View<const std::uint16_t> d_q4);

}  // namespace duo::app
