// The legend that explains the colours of disparity.
#pragma once

#include "duoptic/paint.h"

namespace duo {

/// A strip with the colours and round values; in metres when `rectified` is given, else in px. Sizes follow its height.
void draw_legend(View<Rgb8> dst, const DisparityRange& range, const Rectified* rectified);

}  // namespace duo
