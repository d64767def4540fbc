#include "sources/synthetic/shading.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "sources/synthetic/noise.h"
#include "sources/synthetic/textures.h"

namespace duo::synthetic {

Surface surface_at(const Scene& scene, const Ray& ray, const Hit& hit) {
  if (hit.shape < 0) return {};
  const Vec3 p = ray.origin + hit.t * ray.direction;
  return {hit.shape, hit.t, p, scene.normal(hit.shape, p)};
}

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

Light rough_light(const Eye& eye, const Surface& s, int y, int x) {
  return light_at(eye.scene, s.p_in_world_m, s.normal, eye.towards(s.p_in_world_m), (y & 3) * 4 + (x & 3));
}

Light full_light(const Eye& eye, const Surface& s) {
  Light sum;
  for (int phase = 0; phase < kPhases; ++phase)
    sum = sum + light_at(eye.scene, s.p_in_world_m, s.normal, eye.towards(s.p_in_world_m), phase);
  return (1.0 / kPhases) * sum;
}

Color shade(const Eye& eye, const Surface& s, const Light& light, double apart_px) {
  const Shape& shape = eye.scene.shapes[s.shape];
  const Material& material = eye.scene.materials[shape.material];
  const Mat3 shape_from_world = transposed(shape.world_from_shape.rotation);
  TexturePoint at;
  at.p_m = shape_from_world * (s.p_in_world_m - shape.world_from_shape.t_m);
  at.normal = shape_from_world * s.normal;
  if (const Blend* blend = std::get_if<Blend>(&shape.solid)) at.p_m = blend->at_rest(at.p_m);
  at.half_m = half_extent(shape.solid);
  const double facing = std::abs(dot(s.normal, eye.towards(s.p_in_world_m)));
  // A slanted surface stretches it one way only, so by the root.
  at.footprint_m = apart_px * s.z_m / eye.camera.fx_px / std::sqrt(std::max(facing, 0.05));
  at.seed = mix(static_cast<std::uint32_t>(s.shape) + 1);
  const Color color = texture(material, at);
  return color * light.diffuse + material.gloss * light.highlight + material.emission * color;
}

}  // namespace duo::synthetic
