// The point that a pixel with a disparity shows.
#pragma once

#include <optional>

#include "duoptic/frame.h"
#include "duoptic/rig.h"

namespace duo {

/// In the rig frame, metres; none without disparity and at infinity (d = 0).
inline std::optional<Vec3> point_at(View<const std::uint16_t> d_q4, const Rectified& rectified, int y, int x) {
  const std::uint16_t d = d_q4.at(y, x);
  if (d == Disparity::kNone || d == 0) return {};
  return rectified.triangulate({static_cast<double>(x), static_cast<double>(y)}, d / 16.0);
}

}  // namespace duo
