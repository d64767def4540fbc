// The parts that draw_panels() puts together.
#pragma once

#include "duoptic/sink.h"

namespace duo {

/// Of draw_panels(): whatever the frame.
Size panels_size(const TrackHeader& header);

/// The colour of a hue at full saturation.
///
/// Units  256 = full circle
Rgb8 color_of_hue(int hue);

}  // namespace duo
