// Pictures in blocks of pixels, and points behind the skin.
#pragma once

#include "duoptic/rig.h"

namespace duo {

/// Where a place lies in a picture whose pixels are blocks of step x step.
inline Vec2 in_blocks(Vec2 at_px, double step) { return {(at_px.x + 0.5) / step - 0.5, (at_px.y + 0.5) / step - 0.5}; }
/// The camera of that picture.
inline Pinhole in_blocks(const Pinhole& camera, int step) {
  const Vec2 c = in_blocks(Vec2{camera.cx_px, camera.cy_px}, step);
  return {camera.focal_px / step, c.x, c.y, camera.baseline_m};
}

/// The point `depth_m` behind p on its viewing ray: from the skin to the joint.
inline Vec3 behind(Vec3 p, double depth_m) { return (1 + depth_m / norm(p)) * p; }

}  // namespace duo
