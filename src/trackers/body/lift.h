// Depth at a place of the picture, as surfaces: where a window covers several of them, each by itself.
#pragma once

#include <array>
#include <span>

#include "duoptic/frame.h"
#include "duoptic/rig.h"

namespace duo::body {

/// One surface in a window.
///
/// Units  z_m: median depth; share: of the window's pixels, those near its centre counting more
struct Surface {
  double z_m = 0;
  double share = 0;
  bool hides = false;  // something that stands before the person
};

/// Nearest first.
struct Surfaces {
  std::array<Surface, 4> all = {};
  std::size_t count = 0;
  std::span<const Surface> get() const { return {all.data(), count}; }
  /// Whether something stands before the person there.
  bool is_hidden() const { return count > 0 && all[0].hides; }
};

/// A frame's disparity with its geometry.
struct DepthView {
  View<const std::uint16_t> d_q4;
  const Rectified* geometry = nullptr;

  /// Disparity on clothes and skin comes out this much too small, by exact depth of rendered people.
  static constexpr double kShort_px = 0.08;
  /// On limbs, which are thin beside a matcher's windows, by so much more.
  static constexpr double kThin_px = 0.1;

  double z_m(std::uint16_t q4) const { return geometry->focal_px * geometry->baseline_m / (q4 / 16.0 + kShort_px); }
  /// Depth that a change of one pixel of disparity makes.
  double m_per_px(double z) const { return z * z / (geometry->focal_px * geometry->baseline_m); }
  double px_per_m(double z) const { return geometry->focal_px / z; }
};

struct DepthRange {
  double near_m = 0, far_m = 0;
};
inline constexpr DepthRange kAnyDepth = {0.25, 15};

/// The surfaces in the square of `half_m` around a place, at depth z; a gap of more than 2 cm, or of what disparity can tell,
/// parts two. Those with less than 6 % of the window are left out.
Surfaces surfaces_at(const DepthView& depth, Vec2 at_px, double z, double half_m, DepthRange range);

/// Whether what is between the four corners of a trunk stands out of what is on both sides of it. Of a picture on a wall it
/// does not: both lie in one plane. True where too little is known.
bool stands_out(const DepthView& depth, const std::array<Vec2, 4>& corners_px);

/// Median depth on the trunk between four corners (left and right shoulder, left and right hip); 0 where less than an eighth of
/// it is known.
double trunk_depth(const DepthView& depth, const std::array<Vec2, 4>& corners_px, DepthRange range);

}  // namespace duo::body
