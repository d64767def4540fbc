#include "core/lens.h"

#include <cmath>

namespace duo {
namespace {

// No pinhole lens sees further than 80 degrees from its axis.
constexpr double kMaxTangent = 5.67;

/// The radial factor g = (1 + k1 r2 + k2 r2^2 + k3 r2^3) / (1 + k4 r2 + k5 r2^2 + k6 r2^3), with its slope by r2.
struct Radial {
  double g, slope, denominator;
};

Radial radial(const std::array<double, 8>& k, double r2) {
  const double n = 1 + r2 * (k[0] + r2 * (k[1] + r2 * k[4])), n_slope = k[0] + r2 * (2 * k[1] + r2 * 3 * k[4]);
  const double d = 1 + r2 * (k[5] + r2 * (k[6] + r2 * k[7])), d_slope = k[5] + r2 * (2 * k[6] + r2 * 3 * k[7]);
  return {n / d, (n_slope * d - n * d_slope) / (d * d), d};
}

/// Radius up to which r g(r2) rises.
double rising_until(const std::array<double, 8>& k) {
  constexpr int kSteps = 4000;
  double rising = 0;
  for (int i = 1; i <= kSteps; ++i) {
    const double r = kMaxTangent * i / kSteps, r2 = r * r;
    const Radial at = radial(k, r2);
    if (!(at.denominator > 0 && at.g + 2 * r2 * at.slope > 0)) return rising;
    rising = r;
  }
  return rising;
}

struct Distorted {
  Vec2 at;
  double xx, xy, yy;  // its derivatives: d at.x / dx, d at.x / dy = d at.y / dx, d at.y / dy
};

Distorted distort(const std::array<double, 8>& k, Vec2 p) {
  const double p1 = k[2], p2 = k[3], x = p.x, y = p.y, r2 = x * x + y * y;
  const Radial r = radial(k, r2);
  return {{x * r.g + 2 * p1 * x * y + p2 * (r2 + 2 * x * x), y * r.g + p1 * (r2 + 2 * y * y) + 2 * p2 * x * y},
          r.g + 2 * x * x * r.slope + 2 * p1 * y + 6 * p2 * x,
          2 * x * y * r.slope + 2 * p1 * x + 2 * p2 * y,
          r.g + 2 * y * y * r.slope + 6 * p1 * y + 2 * p2 * x};
}

}  // namespace

Lens::Lens(const Camera& camera) : camera_(camera), max_tangent_(rising_until(camera.distortion)) {}

std::optional<Vec2> Lens::pixel_of(Vec3 p) const {
  if (!(p.z > 0)) return {};
  const Vec2 ray = {p.x / p.z, p.y / p.z};
  if (!(std::hypot(ray.x, ray.y) <= max_tangent_ + 1e-12)) return {};
  const Vec2 at = distort(camera_.distortion, ray).at;
  return Vec2{camera_.fx_px * at.x + camera_.cx_px, camera_.fy_px * at.y + camera_.cy_px};
}

// Newton's method on both coordinates, from the ray that an ideal lens would give; steps stay before the turning point.
std::optional<Vec3> Lens::ray_of(Vec2 pixel_px) const {
  const Vec2 want = {(pixel_px.x - camera_.cx_px) / camera_.fx_px, (pixel_px.y - camera_.cy_px) / camera_.fy_px};
  constexpr double kTolerance = 1e-12;  // of a tangent: far below a thousandth of a pixel
  Vec2 ray = want;
  for (int i = 0; i < 40; ++i) {
    if (const double r = std::hypot(ray.x, ray.y); r > max_tangent_) {
      const double s = 0.98 * max_tangent_ / r;
      ray = {s * ray.x, s * ray.y};
    }
    const Distorted now = distort(camera_.distortion, ray);
    const Vec2 miss = {want.x - now.at.x, want.y - now.at.y};
    if (std::abs(miss.x) < kTolerance && std::abs(miss.y) < kTolerance) return Vec3{ray.x, ray.y, 1};
    const double det = now.xx * now.yy - now.xy * now.xy;
    if (!(std::abs(det) > 1e-9)) return {};
    ray.x += (now.yy * miss.x - now.xy * miss.y) / det;
    ray.y += (now.xx * miss.y - now.xy * miss.x) / det;
  }
  return {};
}

}  // namespace duo
