// Disparity as colours over a given range, and the legend that explains them.
#pragma once

#include "duoptic/sink.h"

namespace duo {

/// Where there is no disparity, `dst` becomes black.
///
/// Shape  both H x W
void color_disparity(View<const std::uint16_t> d_q4, const DisparityRange& range, View<Rgb8> dst);

/// A strip with the colours and round values; in metres when `rectified` is given, else in px. Sizes follow its height.
void draw_legend(View<Rgb8> dst, const DisparityRange& range, const Rectified* rectified);

}  // namespace duo
