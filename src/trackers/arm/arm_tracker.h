// The tracker "arm", preset "default".
#pragma once

#include <memory>

#include "duoptic/tracker.h"

namespace duo {

/// Follows one or two arms by colour, depth and the body's own constraints.
///
/// Source  the thesis (hue blobs, SIFT) with what its failures call for: static background, skin against cloth, a rigid torso
/// for
///         the shoulder, bone lengths for the elbow. Trackers of this kind: Wren et al., "Pfinder", 1997; Hua, Wu, "Multi-scale
///         visual tracking by sequential belief propagation", 2004
std::unique_ptr<Tracker> make_arm_tracker();

}  // namespace duo
