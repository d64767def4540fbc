#include "sources/synthetic/render.h"

#include <algorithm>
#include <cmath>

#include "sources/synthetic/shading.h"

namespace duo::synthetic {
namespace {

struct Resolver {
  const Eye& eye;
  const Image<Surface>& surfaces;
  const Image<Light>& light;

  // The light for a surface found between pixel centres: that of a pixel beside it if one shows the same, else its own.
  Light light_for(const Surface& s, int y, int x) const {
    if (same_surface(s, surfaces.at(y, x))) return light.at(y, x);
    for (int yy = std::max(y - 1, 0); yy <= std::min(y + 1, surfaces.height() - 1); ++yy)
      for (int xx = std::max(x - 1, 0); xx <= std::min(x + 1, surfaces.width() - 1); ++xx)
        if (same_surface(s, surfaces.at(yy, xx))) return light.at(yy, xx);
    return full_light(eye, s);
  }

  // Whether all pixels around show one shape: then only that one needs to be met again.
  bool inside_shape(int y, int x) const {
    const int shape = surfaces.at(y, x).shape;
    for (int yy = std::max(y - 1, 0); yy <= std::min(y + 1, surfaces.height() - 1); ++yy)
      for (int xx = std::max(x - 1, 0); xx <= std::min(x + 1, surfaces.width() - 1); ++xx)
        if (surfaces.at(yy, xx).shape != shape) return false;
    return shape >= 0;
  }

  Color pixel(int y, int x) const {
    const bool inside = inside_shape(y, x);
    Color sum;
    for (const Point2& point : kPixelPoints) {
      const Ray ray = eye.ray(x + point.x, y + point.y);
      const int centre = surfaces.at(y, x).shape;
      Hit hit = inside ? Hit{centre, eye.scene.trace(ray, centre)} : eye.scene.trace(ray);
      if (hit.t == kNever) hit = eye.scene.trace(ray);
      const Surface s = surface_at(eye.scene, ray, hit);
      if (s.shape >= 0) sum = sum + 0.25 * shade(eye, s, light_for(s, y, x), 0.5);
    }
    return sum;
  }
};

}  // namespace

Rendering render(Pool& pool, const Scene& scene, const Camera& camera, const Rigid3& world_from_camera) {
  const Eye eye{scene, camera, world_from_camera};
  const Size size = camera.size;
  Rendering out{Image<Surface>(size), Image<Color>(size)};
  Image<Light> rough(size), light(size);
  each_row(pool, size.height, [&](int y) {
    for (int x = 0; x < size.width; ++x) {
      const Ray ray = eye.ray(x, y);
      Surface& s = out.surfaces.at(y, x);
      s = surface_at(scene, ray, scene.trace(ray));
      if (s.shape < 0) continue;
      rough.at(y, x) = rough_light(eye, s, y, x);
    }
  });
  each_row(pool, size.height, [&](int y) {
    for (int x = 0; x < size.width; ++x)
      if (out.surfaces.at(y, x).shape >= 0) light.at(y, x) = averaged(out.surfaces, rough, y, x);
  });
  const Resolver resolver{eye, out.surfaces, light};
  each_row(pool, size.height, [&](int y) {
    for (int x = 0; x < size.width; ++x) out.colors.at(y, x) = resolver.pixel(y, x);
  });
  return out;
}

}  // namespace duo::synthetic
