// The files that a frame becomes.
#pragma once

#include <optional>

#include "duoptic/frame.h"
#include "output.h"

namespace duo::app {

/// Writes disparity.pfm and disparity.png, with a rig also depth.png (u16 mm, 0 = none) and cloud.ply, into `out`.
Result<void> write_frame(const Frame& frame, const std::optional<Rectified>& rectified, OutputSet& out);

/// Share of pixels with a disparity, 0 .. 1.
double coverage(const Frame& frame);

}  // namespace duo::app
