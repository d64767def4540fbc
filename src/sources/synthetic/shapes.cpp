#include "sources/synthetic/shapes.h"

#include <algorithm>
#include <cmath>

namespace duo::synthetic {
namespace {

struct Span {
  double in, out;
};

// Where the ray is inside |x| <= half.x, |y| <= half.y, |z| <= half.z; empty when in > out.
Span slabs(Vec3 half, const Ray& ray) {
  Span span{-kNever, kNever};
  const auto cut = [&](double o, double d, double h) {
    if (d == 0) {
      if (std::abs(o) > h) span.in = kNever;
      return;
    }
    const double inverse = 1 / d, a = (-h - o) * inverse, b = (h - o) * inverse;
    span.in = std::max(span.in, std::min(a, b));
    span.out = std::min(span.out, std::max(a, b));
  };
  cut(ray.origin.x, ray.direction.x, half.x);
  cut(ray.origin.y, ray.direction.y, half.y);
  cut(ray.origin.z, ray.direction.z, half.z);
  return span;
}

// Sphere tracing between two known ends: `distance` never exceeds the true distance to the surface.
// Source  Hart, "Sphere tracing", 1996
template <class Distance>
double march(const Ray& ray, Span span, double t_min, Distance distance) {
  constexpr double kClose_m = 1e-7;
  constexpr int kMaxSteps = 96;
  const double per_m = 1 / norm(ray.direction);
  double t = std::max(span.in, t_min);
  if (span.in < t_min && distance(ray.origin + t * ray.direction) < 0) return kNever;  // starts inside
  for (int i = 0; i < kMaxSteps && t <= span.out; ++i) {
    const double d = distance(ray.origin + t * ray.direction);
    if (d < kClose_m) return t > t_min ? t : kNever;
    t += d * per_m;
  }
  return kNever;
}

Vec3 beyond(Vec3 p, Vec3 inner) {
  return {std::max(std::abs(p.x) - inner.x, 0.0), std::max(std::abs(p.y) - inner.y, 0.0),
          std::max(std::abs(p.z) - inner.z, 0.0)};
}

Vec3 inner_half(const Box& box) {
  const double r = box.rounding_m;
  return {box.half.x - r, box.half.y - r, box.half.z - r};
}

double enter(const Box& box, const Ray& ray, double t_min) {
  const Span span = slabs(box.half, ray);
  if (span.in > span.out || span.out <= t_min) return kNever;
  if (box.rounding_m <= 0) return span.in > t_min ? span.in : kNever;
  const Vec3 inner = inner_half(box);
  return march(ray, span, t_min, [&](Vec3 p) { return norm(beyond(p, inner)) - box.rounding_m; });
}

double enter(const Ellipsoid& e, const Ray& ray, double t_min) {
  const Vec3 o{ray.origin.x / e.radii.x, ray.origin.y / e.radii.y, ray.origin.z / e.radii.z};
  const Vec3 d{ray.direction.x / e.radii.x, ray.direction.y / e.radii.y, ray.direction.z / e.radii.z};
  const double a = dot(d, d), b = dot(o, d), h = b * b - a * (dot(o, o) - 1);
  if (h < 0) return kNever;
  const double t = (-b - std::sqrt(h)) / a;
  return t > t_min ? t : kNever;
}

double enter(const Capsule& c, const Ray& ray, double t_min) {
  const Vec3 o = ray.origin, d = ray.direction;
  const double rr = c.radius_m * c.radius_m, a = d.x * d.x + d.z * d.z;
  double end = d.y > 0 ? -c.half_length_m : c.half_length_m;  // the cap seen when the ray runs along the axis
  if (a > 0) {
    const double b = o.x * d.x + o.z * d.z, h = b * b - a * (o.x * o.x + o.z * o.z - rr);
    if (h < 0) return kNever;
    const double t = (-b - std::sqrt(h)) / a, y = o.y + t * d.y;
    if (std::abs(y) <= c.half_length_m) return t > t_min ? t : kNever;
    end = y < 0 ? -c.half_length_m : c.half_length_m;
  }
  const double t = enter(Ellipsoid{{c.radius_m, c.radius_m, c.radius_m}}, {o - Vec3{0, end, 0}, d}, t_min);
  return t;
}

double enter(const Frustum& f, const Ray& ray, double t_min) {
  const Vec3 o = ray.origin, d = ray.direction;
  const double slope = (f.bottom_m - f.top_m) / (2 * f.half_height_m), middle = (f.top_m + f.bottom_m) / 2;
  double best = kNever;
  // Ends facing the ray.
  if (d.y != 0) {
    const double y = d.y > 0 ? -f.half_height_m : f.half_height_m, t = (y - o.y) / d.y;
    const double x = o.x + t * d.x, z = o.z + t * d.z, r = d.y > 0 ? f.top_m : f.bottom_m;
    if (t > t_min && x * x + z * z <= r * r) best = t;
  }
  // Side: x^2 + z^2 = (middle + slope y)^2; it is entered where that falls below zero.
  const double r0 = middle + slope * o.y, dr = slope * d.y;
  const double a = d.x * d.x + d.z * d.z - dr * dr, b = o.x * d.x + o.z * d.z - r0 * dr, c = o.x * o.x + o.z * o.z - r0 * r0;
  const double h = b * b - a * c;
  if (h < 0 || a == 0) return best;
  const double t = (-b - std::sqrt(h)) / a;  // also right for a < 0: the root where the quadratic falls is the same one
  if (t > t_min && t < best && std::abs(o.y + t * d.y) <= f.half_height_m) best = t;
  return best;
}

double enter(const Blend& b, const Ray& ray, double t_min) { return b.enter(ray.origin, ray.direction, t_min); }

Vec3 normal(const Box& box, Vec3 p) {
  const auto sign = [](double v) { return v < 0 ? -1.0 : 1.0; };
  if (box.rounding_m > 0) {
    const Vec3 q = beyond(p, inner_half(box));
    if (dot(q, q) > 0) return normalized({sign(p.x) * q.x, sign(p.y) * q.y, sign(p.z) * q.z});
  }
  const double x = std::abs(p.x) - box.half.x, y = std::abs(p.y) - box.half.y, z = std::abs(p.z) - box.half.z;
  if (x >= y && x >= z) return {sign(p.x), 0, 0};
  return y >= z ? Vec3{0, sign(p.y), 0} : Vec3{0, 0, sign(p.z)};
}

Vec3 normal(const Ellipsoid& e, Vec3 p) {
  return normalized({p.x / (e.radii.x * e.radii.x), p.y / (e.radii.y * e.radii.y), p.z / (e.radii.z * e.radii.z)});
}

Vec3 normal(const Capsule& c, Vec3 p) { return normalized(p - Vec3{0, std::clamp(p.y, -c.half_length_m, c.half_length_m), 0}); }

Vec3 normal(const Frustum& f, Vec3 p) {
  constexpr double kOnEnd_m = 1e-9;
  const double slope = (f.bottom_m - f.top_m) / (2 * f.half_height_m), r = std::sqrt(p.x * p.x + p.z * p.z);
  const double side = std::abs(r - ((f.top_m + f.bottom_m) / 2 + slope * p.y));
  if (f.half_height_m - std::abs(p.y) < kOnEnd_m && side > kOnEnd_m) return {0, p.y < 0 ? -1.0 : 1.0, 0};
  return normalized({p.x / r, -slope, p.z / r});
}

Vec3 normal(const Blend& b, Vec3 p) { return b.normal(p); }

Vec3 extent(const Box& box) { return box.half; }
Vec3 extent(const Ellipsoid& e) { return e.radii; }
Vec3 extent(const Capsule& c) { return {c.radius_m, c.half_length_m + c.radius_m, c.radius_m}; }
Vec3 extent(const Frustum& f) {
  const double r = std::max(f.top_m, f.bottom_m);
  return {r, f.half_height_m, r};
}
Vec3 extent(const Blend& b) { return b.half_extent(); }

}  // namespace

double intersect(const Solid& solid, const Ray& ray, double t_min) {
  return std::visit([&](const auto& s) { return enter(s, ray, t_min); }, solid);
}
bool blocks(const Solid& solid, const Ray& ray) {
  if (const Blend* blend = std::get_if<Blend>(&solid)) return blend->blocks(ray.origin, ray.direction);
  return intersect(solid, ray, 0) < 1;
}
Vec3 normal_at(const Solid& solid, Vec3 p) {
  return std::visit([&](const auto& s) { return normal(s, p); }, solid);
}
Vec3 half_extent(const Solid& solid) {
  return std::visit([](const auto& s) { return extent(s); }, solid);
}

}  // namespace duo::synthetic
