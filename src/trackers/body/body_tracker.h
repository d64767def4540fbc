// The tracker "body": whole people, found by themselves.
#pragma once

#include <memory>

#include "duoptic/tracker.h"

namespace duo {

/// Follows up to eight people by the networks of the detectors and the depth of the pair.
std::unique_ptr<Tracker> make_body_tracker();

}  // namespace duo
