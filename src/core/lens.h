// The lens of one raw camera: rays to pixels and back.
#pragma once

#include <optional>

#include "duoptic/rig.h"

namespace duo {

/// A camera's distortion in both directions.
///
/// Far from the axis a distortion polynomial can turn back, so that two rays meet in one pixel; rays from the first turning
/// point on are not seen.
class Lens {
 public:
  explicit Lens(const Camera& camera);

  const Camera& camera() const { return camera_; }

  /// Tangent of the angle between the axis and the last rays that are seen.
  double max_tangent() const { return max_tangent_; }

  /// The pixel that sees a point or ray; none behind the camera or beyond the turning point. May lie outside the picture.
  std::optional<Vec2> pixel_of(Vec3 p_in_camera) const;

  /// The ray (z = 1) that a pixel sees; none where no ray reaches it.
  std::optional<Vec3> ray_of(Vec2 pixel_px) const;

  /// Whether the place lies between the centres of the picture's pixels, give or take `slack_px`.
  bool covers(Vec2 pixel_px, double slack_px = 0) const {
    return pixel_px.x >= -slack_px && pixel_px.y >= -slack_px && pixel_px.x <= camera_.size.width - 1 + slack_px &&
           pixel_px.y <= camera_.size.height - 1 + slack_px;
  }

 private:
  Camera camera_;
  double max_tangent_;
};

}  // namespace duo
