// Rectification: from a rig to one geometry in which a point lies on the same row of both pictures.
#pragma once

#include <optional>

#include "core/lens.h"
#include "duoptic/rig.h"
#include "stages/rectify/rectify.h"

namespace duo {

struct Rectification {
  Rectified geometry;
  ResampleMap left, right;
};

/// The rectified geometry of a rig.
///
/// The x axis lies along the baseline, z is the mean of both optical axes made orthogonal to it. The focal length is the mean
/// of the raw ones. The canvas keeps every pixel of a point at 0.4 m or further that both raw pictures see. A canvas that would
/// pass 1.5 times the raw size gets a shorter focal length instead, down to half.
///
/// Errors  what check_rig() refuses; views without common part, or so far from parallel (or so wide) that half the focal length
/// is not short enough Source  Fusiello, Trucco, Verri, "A compact algorithm for rectification of stereo pairs", 2000; there
/// the z axis follows
///         one camera, here both share the turn
Result<Rectified> rectified_geometry(const Rig& rig, const std::string& name);

/// The same with the maps that resample both raw pictures into it.
Result<Rectification> make_rectification(const Rig& rig, const std::string& name);

/// Makes pixel (y, x) of a map show a place of a raw picture of this size; outside of it, nothing.
void put_place(ResampleMap& map, int y, int x, Vec2 raw_px, Size raw);

/// Where a raw pixel lies on the canvas; `rig_from_camera` says which camera. None where the lens sees no ray, or behind.
std::optional<Vec2> rectified_from_raw(const Rectified& geometry, const Mat3& rig_from_camera, const Lens& lens, Vec2 raw_px);

/// Where a canvas pixel lies in the raw picture; may be outside of it.
std::optional<Vec2> raw_from_rectified(const Rectified& geometry, const Mat3& rig_from_camera, const Lens& lens,
                                       Vec2 rectified_px);

}  // namespace duo
