// What a camera's ray meets, and the colour of it in a given light.
#pragma once

#include <array>

#include "core/pool.h"
#include "duoptic/image.h"
#include "sources/synthetic/lens.h"
#include "sources/synthetic/light.h"
#include "sources/synthetic/scene.h"

namespace duo::synthetic {

/// What the ray through a pixel's centre meets.
struct Surface {
  int shape = -1;  // -1: nothing
  double z_m = 0;  // in the camera
  Vec3 p_in_world_m, normal;
};

/// Where a pixel is sampled: a square turned so that no two points share a row or a column.
inline constexpr std::array<Point2, 4> kPixelPoints = {{{-0.125, -0.375}, {0.375, -0.125}, {-0.375, 0.125}, {0.125, 0.375}}};

/// A camera before a scene.
struct Eye {
  const Scene& scene;
  const Camera& camera;
  const Rigid3& world_from_camera;

  Ray ray(double x, double y) const { return pixel_ray(camera, world_from_camera, {x, y}); }
  Vec3 towards(Vec3 p) const { return normalized(world_from_camera.t_m - p); }
};

/// Every thread gets rows from all heights of the picture: the furniture costs more than the walls.
template <class F>
void each_row(Pool& pool, int height, F row) {
  pool.rows(height, [&](int begin, int end) {
    const int evens = (height + 1) / 2;
    for (int i = begin; i < end; ++i) row(i < evens ? 2 * i : 2 * (i - evens) + 1);
  });
}

Surface surface_at(const Scene& scene, const Ray& ray, const Hit& hit);

/// Whether light found at `b` is right for `a`.
bool same_surface(const Surface& a, const Surface& b);

/// The estimate for one pixel out of the kPhases, by its place in blocks of 4x4.
Light rough_light(const Eye& eye, const Surface& s, int y, int x);

/// The mean of rough estimates over 5x5 pixels on the same surface.
Light averaged(const Image<Surface>& surfaces, const Image<Light>& light, int y, int x);

/// The mean over all phases.
Light full_light(const Eye& eye, const Surface& s);

/// Units  apart_px: distance of the samples of a picture; texture finer than that is left out
Color shade(const Eye& eye, const Surface& s, const Light& light, double apart_px);

}  // namespace duo::synthetic
