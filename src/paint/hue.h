// The colours of hues.
#pragma once

#include "duoptic/image.h"

namespace duo {

/// The colour of a hue at full saturation.
///
/// Units  256 = full circle
Rgb8 color_of_hue(int hue);

}  // namespace duo
