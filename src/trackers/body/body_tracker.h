// The trackers "body" and "body_hands": whole people, found by themselves.
#pragma once

#include <memory>

#include "duoptic/tracker.h"

namespace duo {

/// Follows up to eight people by the networks of the detectors and the depth of the pair.
std::unique_ptr<Tracker> make_body_tracker();
/// The same with their fingers: the network of hands is asked for both hands in each frame, not in turn.
std::unique_ptr<Tracker> make_body_hands_tracker();

}  // namespace duo
