// A pose to begin with.
#pragma once

#include "trackers/body/frame_view.h"
#include "trackers/body/points.h"

namespace duo::body {

/// The body's joints as the network imagines them, put where the trunk is: `trunk_z` is the depth of its skin.
Places imagined(const FrameView& frame, const SeenBody& seen, const Points& points, double trunk_z);

}  // namespace duo::body
