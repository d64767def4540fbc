#include "sources/synthetic/render.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "sources/synthetic/noise.h"
#include "sources/synthetic/textures.h"

namespace duo::synthetic {
namespace {

struct Eye {
  const Scene& scene;
  const Camera& camera;
  const Rigid3& world_from_camera;

  Ray ray(double x, double y) const { return pixel_ray(camera, world_from_camera, {x, y}); }
  Vec3 towards(Vec3 p) const { return normalized(world_from_camera.t_m - p); }
};

// Every thread gets rows from all heights of the picture: the furniture costs more than the walls.
template <class F>
void each_row(Pool& pool, int height, F row) {
  pool.rows(height, [&](int begin, int end) {
    const int evens = (height + 1) / 2;
    for (int i = begin; i < end; ++i) row(i < evens ? 2 * i : 2 * (i - evens) + 1);
  });
}

Surface surface_at(const Scene& scene, const Ray& ray, const Hit& hit) {
  if (hit.shape < 0) return {};
  const Vec3 p = ray.origin + hit.t * ray.direction;
  return {hit.shape, hit.t, p, scene.normal(hit.shape, p)};
}

// Whether light found at `b` is right for `a`.
bool same_surface(const Surface& a, const Surface& b) {
  constexpr double kFlat_m = 0.01, kAligned = 0.9;
  return a.shape == b.shape && a.shape >= 0 && dot(a.normal, b.normal) > kAligned &&
         std::abs(dot(a.normal, b.p_in_world_m - a.p_in_world_m)) < kFlat_m;
}

// 5x5 with halved rims: each of the 4x4 phases has the same weight.
Light averaged(const Image<Surface>& surfaces, const Image<Light>& light, int y, int x) {
  constexpr std::array<double, 5> kWeight = {0.5, 1, 1, 1, 0.5};
  Light sum;
  double weights = 0;
  for (int dy = -2; dy <= 2; ++dy)
    for (int dx = -2; dx <= 2; ++dx) {
      const int yy = y + dy, xx = x + dx;
      if (yy < 0 || xx < 0 || yy >= surfaces.height() || xx >= surfaces.width()) continue;
      if (!same_surface(surfaces.at(y, x), surfaces.at(yy, xx))) continue;
      const double weight = kWeight[dy + 2] * kWeight[dx + 2];
      sum = sum + weight * light.at(yy, xx);
      weights += weight;
    }
  return (1 / weights) * sum;
}

Light full_light(const Eye& eye, const Surface& s) {
  Light sum;
  for (int phase = 0; phase < kPhases; ++phase)
    sum = sum + light_at(eye.scene, s.p_in_world_m, s.normal, eye.towards(s.p_in_world_m), phase);
  return (1.0 / kPhases) * sum;
}

Color shade(const Eye& eye, const Surface& s, const Light& light) {
  const Shape& shape = eye.scene.shapes[s.shape];
  const Material& material = eye.scene.materials[shape.material];
  const Mat3 shape_from_world = transposed(shape.world_from_shape.rotation);
  TexturePoint at;
  at.p_m = shape_from_world * (s.p_in_world_m - shape.world_from_shape.t_m);
  at.normal = shape_from_world * s.normal;
  at.half_m = half_extent(shape.solid);
  const double facing = std::abs(dot(s.normal, eye.towards(s.p_in_world_m)));
  // Half a pixel is the distance of the four points; a slanted surface stretches it one way only, so by the root.
  at.footprint_m = 0.5 * s.z_m / eye.camera.fx_px / std::sqrt(std::max(facing, 0.05));
  at.seed = mix(static_cast<std::uint32_t>(s.shape) + 1);
  const Color color = texture(material, at);
  return color * light.diffuse + material.gloss * light.highlight + material.emission * color;
}

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
    // A square turned so that no two points share a row or a column.
    constexpr std::array<Point2, 4> kPoints = {{{-0.125, -0.375}, {0.375, -0.125}, {-0.375, 0.125}, {0.125, 0.375}}};
    const bool inside = inside_shape(y, x);
    Color sum;
    for (const Point2& point : kPoints) {
      const Ray ray = eye.ray(x + point.x, y + point.y);
      const int centre = surfaces.at(y, x).shape;
      Hit hit = inside ? Hit{centre, eye.scene.trace(ray, centre)} : eye.scene.trace(ray);
      if (hit.t == kNever) hit = eye.scene.trace(ray);
      const Surface s = surface_at(eye.scene, ray, hit);
      if (s.shape >= 0) sum = sum + 0.25 * shade(eye, s, light_for(s, y, x));
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
      rough.at(y, x) = light_at(scene, s.p_in_world_m, s.normal, eye.towards(s.p_in_world_m), (y & 3) * 4 + (x & 3));
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
