#include "sources/synthetic/projector.h"

#include <algorithm>
#include <cmath>

#include "core/check.h"
#include "sources/synthetic/noise.h"
#include "sources/synthetic/render.h"

namespace duo::synthetic {
namespace {

/// Light of a value on the screen: the cubic of srgb(), as displays and projectors show it.
double light_of(double value) {
  const double v = value / 255;
  return v * (v * (v * 0.305306011 + 0.682171111) + 0.012522878);
}

/// Between the pixels' centres: its optics blur the screen.
double light_at_place(View<const std::uint8_t> pattern, double x_px, double y_px) {
  const double x = std::clamp(x_px - 0.5, 0.0, pattern.width() - 1.0), y = std::clamp(y_px - 0.5, 0.0, pattern.height() - 1.0);
  const int x0 = std::min(floor_int(x), std::max(pattern.width() - 2, 0)),
            y0 = std::min(floor_int(y), std::max(pattern.height() - 2, 0));
  const int x1 = std::min(x0 + 1, pattern.width() - 1), y1 = std::min(y0 + 1, pattern.height() - 1);
  const double u = x - x0, v = y - y0;
  return (light_of(pattern.at(y0, x0)) * (1 - u) + light_of(pattern.at(y0, x1)) * u) * (1 - v) +
         (light_of(pattern.at(y1, x0)) * (1 - u) + light_of(pattern.at(y1, x1)) * u) * v;
}

Vec3 towards_projector(const Projector& projector, const Surface& s) {
  return projector.world_from_projector.t_m - s.p_in_world_m;
}

}  // namespace

std::optional<Point2> Projector::place_of(Vec3 p_in_world_m) const {
  const Vec3 p = inverse(world_from_projector) * p_in_world_m;
  if (p.z <= 0) return std::nullopt;
  const Point2 at{focal_px * p.x / p.z + screen.width / 2.0, focal_px * p.y / p.z + screen.height / 2.0};
  if (at.x < 0 || at.y < 0 || at.x >= screen.width || at.y >= screen.height) return std::nullopt;
  return at;
}

bool is_lit(const Scene& scene, const Projector& projector, const Surface& s) {
  if (s.shape < 0 || !projector.place_of(s.p_in_world_m)) return false;
  const Vec3 way = towards_projector(projector, s);
  const Vec3 lift = scene.lift_m * s.normal;
  return dot(s.normal, way) > 0 && !scene.blocked({s.p_in_world_m + lift, way - lift});
}

ProjectedView::ProjectedView(Pool& pool, const Scene& scene, const Projector& projector, const Camera& camera,
                             const Rigid3& world_from_camera)
    : room_(render(pool, scene, camera, world_from_camera).colors), points_(camera.size) {
  const Eye eye{scene, camera, world_from_camera};
  each_row(pool, camera.size.height, [&](int y) {
    for (int x = 0; x < camera.size.width; ++x)
      for (std::size_t i = 0; i < kPixelPoints.size(); ++i) {
        const Ray ray = eye.ray(x + kPixelPoints[i].x, y + kPixelPoints[i].y);
        const Surface s = surface_at(scene, ray, scene.trace(ray));
        if (!is_lit(scene, projector, s)) continue;
        const Vec3 way = towards_projector(projector, s);
        const double far_m = norm(way);
        const Light light{dot(s.normal, way) / (far_m * far_m * far_m) * projector.power, {}};
        const Point2 at = *projector.place_of(s.p_in_world_m);
        Color white = shade(eye, s, light, 0.5);
        // What glows does so without the projector.
        const Color dark = shade(eye, s, {}, 0.5);
        white = white + -1 * dark;
        points_.at(y, x).at[i] = {static_cast<float>(at.x), static_cast<float>(at.y), 0.25 * white};
      }
  });
}

Image<Color> ProjectedView::draw(Pool& pool, View<const std::uint8_t> pattern, double ambient) const {
  Image<Color> out(room_.size());
  pool.rows(out.height(), [&](int begin, int end) {
    for (int y = begin; y < end; ++y)
      for (int x = 0; x < out.width(); ++x) {
        out.at(y, x) = ambient * room_.at(y, x);
        if (pattern.empty()) continue;
        for (const Point& point : points_.at(y, x).at)
          if (point.white.g > 0) out.at(y, x) = out.at(y, x) + light_at_place(pattern, point.x_px, point.y_px) * point.white;
      }
  });
  return out;
}

}  // namespace duo::synthetic
