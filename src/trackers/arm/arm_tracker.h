// The tracker "arm", preset "default".
#pragma once

#include <memory>

#include "duoptic/tracker.h"

namespace duo {

/// Follows one or two arms by depth, colour and what a body can do.
///
/// Source  the thesis (hue blobs, SIFT) with what its failures call for: a static background and a likelihood of skin (as in
/// Wren
///         et al., "Pfinder", 1997), a rigid torso for the shoulder, both bone lengths for the elbow (O'Rourke, Badler,
///         "Model-based image analysis of human motion using constraint propagation", 1980: predict, observe, update)
std::unique_ptr<Tracker> make_arm_tracker();

}  // namespace duo
