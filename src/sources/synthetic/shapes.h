// Solid shapes and where a ray enters them. Each lies around the origin of its own frame; a scene places it by a rigid motion.
#pragma once

#include <limits>
#include <variant>

#include "duoptic/geometry.h"
#include "sources/synthetic/blend.h"

namespace duo::synthetic {

inline constexpr double kNever = std::numeric_limits<double>::infinity();

/// Points origin + t direction; the direction need not have length 1, so that t can count what suits the caller
/// (depth along a camera's axis, the share of the way to a light).
struct Ray {
  Vec3 origin, direction;
};

/// `half` is half the outer edge lengths; edges and corners are rounded off with radius `rounding_m`.
struct Box {
  Vec3 half;
  double rounding_m = 0;
};

struct Ellipsoid {
  Vec3 radii;
};

/// All points within `radius_m` of the segment (0, -half_length_m, 0) .. (0, half_length_m, 0).
struct Capsule {
  double half_length_m = 0, radius_m = 0;
};

/// Cylinder or cut cone along y, closed at both ends; y points down, so `top_m` is the radius at -half_height_m.
struct Frustum {
  double half_height_m = 0, top_m = 0, bottom_m = 0;
};

using Solid = std::variant<Box, Ellipsoid, Capsule, Frustum, Blend>;

/// The t > t_min at which the ray enters the solid, or kNever. Rays that start inside see nothing of it.
///
/// Exact  closed form, to rounding; rounded boxes are marched to within 1e-7 m, blends to within 2e-6 m
double intersect(const Solid& solid, const Ray& ray, double t_min);

/// Whether the ray enters the solid at 0 < t < 1; thin rims of blends may be missed.
bool blocks(const Solid& solid, const Ray& ray);

/// Outward unit normal at a point of the surface.
Vec3 normal_at(const Solid& solid, Vec3 p);

/// Half the edge lengths of the axis-aligned box around the solid in its own frame.
Vec3 half_extent(const Solid& solid);

}  // namespace duo::synthetic
