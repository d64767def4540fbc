// Bones that keep their lengths in files.
#pragma once

#include <memory>
#include <optional>

#include "duoptic/sink.h"

namespace duo {

/// `sink` behind up to 75 frames, 2.5 s at 30 per second, where it is of a file and wants no pictures. A tracker learns how
/// long a person's bones are in the first seconds, in which it publishes what it knows so far; the frames wait until it holds
/// to the lengths, and are written with those. So files have bones of the same lengths from a person's first frame on, until
/// one turns out to be wrong by more than 2 cm. Joints keep the directions of their bones and, on the mean, their places.
///
/// Of whole bodies alone, and with a rig; other sinks stay as they are. Who is gone, or changes still, when its first frame has
/// waited that long, has the lengths of then.
std::unique_ptr<Sink> with_settled_bones(std::unique_ptr<Sink> sink, const std::optional<Rig>& rig, const Rectified& rectified);

}  // namespace duo
