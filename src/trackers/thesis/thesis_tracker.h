// The tracker "thesis": as published, with its failures, to measure the tracker "arm" against.
#pragma once

#include <memory>

#include "duoptic/tracker.h"

namespace duo {

/// Three blobs of one hue, followed each for itself; points as second opinion; depth read back at the joint's pixel.
///
/// What the thesis leaves open is ours: windows of a sixth of the picture's width, points weigh as much as the blob, a joint
/// whose blob is gone stays where it was as inferred, and is lost after a second. Sigma is a constant: the thesis states none.
std::unique_ptr<Tracker> make_thesis_tracker();

}  // namespace duo
