// A projector in the room, and what a camera sees of its patterns.
#pragma once

#include <array>
#include <optional>

#include "core/pool.h"
#include "sources/synthetic/shading.h"

namespace duo::synthetic {

/// A pinhole that throws pictures.
struct Projector {
  Rigid3 world_from_projector;  // z along its axis
  Size screen;
  double focal_px = 0;      // its axis leaves through the middle of the screen
  Color power = {1, 1, 1};  // of white: irradiance at 1 m, straight ahead

  /// Where on the screen a point is lit from, px, 0 at the edge of the first pixel; none behind it or beside its picture.
  std::optional<Point2> place_of(Vec3 p_in_world_m) const;
};

/// Whether the projector's light reaches a surface: from its front, within its picture, and nothing is in between.
bool is_lit(const Scene& scene, const Projector& projector, const Surface& s);

/// A camera's view of a still scene before a projector. Light adds up: the scene is rendered once, and each pattern is a sum.
class ProjectedView {
 public:
  ProjectedView(Pool& pool, const Scene& scene, const Projector& projector, const Camera& camera,
                const Rigid3& world_from_camera);

  /// The scene in `ambient` times its own light and in that of a pattern (empty: none).
  ///
  /// Shape  pattern: the projector's screen
  Image<Color> draw(Pool& pool, View<const std::uint8_t> pattern, double ambient) const;

 private:
  struct Point {  // one of the four of a pixel
    float x_px = 0, y_px = 0;
    Color white;  // what it adds in white light; black in the shadow
  };
  struct Points {
    std::array<Point, kPixelPoints.size()> at;
  };
  Image<Color> room_;
  Image<Points> points_;
};

}  // namespace duo::synthetic
