// Rays of a camera with a distorting lens.
#pragma once

#include "duoptic/rig.h"
#include "sources/synthetic/shapes.h"

namespace duo::synthetic {

struct Point2 {
  double x = 0, y = 0;
};

/// Where the lens puts a point of the plane z = 1, in px.
Point2 project(const Camera& camera, Point2 on_plane);

/// The point of the plane z = 1 seen at a raw pixel: Newton's method on project(), to 1e-12.
///
/// Errors  none while the distortion can be inverted over the picture; the rigs made here can
Point2 unproject(const Camera& camera, Point2 pixel);

/// The ray of a pixel in the world; t is the depth z in the camera.
inline Ray pixel_ray(const Camera& camera, const Rigid3& world_from_camera, Point2 pixel) {
  const Point2 p = unproject(camera, pixel);
  return {world_from_camera.t_m, world_from_camera.rotation * Vec3{p.x, p.y, 1}};
}

}  // namespace duo::synthetic
