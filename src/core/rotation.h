// Rotations about an axis.
#pragma once

#include <cmath>

#include "duoptic/geometry.h"

namespace duo {

/// The rotation by |w| radians around w.
///
/// Source  Rodrigues, "Des lois géométriques ...", 1840
inline Mat3 rotation_of(Vec3 w) {
  const double angle = norm(w);
  if (angle < 1e-12) return {};
  const Vec3 k = (1 / angle) * w;
  const double s = std::sin(angle), c = 1 - std::cos(angle);
  return {{1 - c * (k.y * k.y + k.z * k.z), -s * k.z + c * k.x * k.y, s * k.y + c * k.x * k.z,  //
           s * k.z + c * k.x * k.y, 1 - c * (k.x * k.x + k.z * k.z), -s * k.x + c * k.y * k.z,  //
           -s * k.y + c * k.x * k.z, s * k.x + c * k.y * k.z, 1 - c * (k.x * k.x + k.y * k.y)}};
}

/// Axis times sine of a rotation's angle: its inverse for small angles.
inline Vec3 axis_of(const Mat3& r) { return {0.5 * (r(2, 1) - r(1, 2)), 0.5 * (r(0, 2) - r(2, 0)), 0.5 * (r(1, 0) - r(0, 1))}; }

}  // namespace duo
