// How much light reaches a point of a surface.
#pragma once

#include "sources/synthetic/scene.h"

namespace duo::synthetic {

/// diffuse: times the reflectance; highlight: added to it, times the material's gloss.
struct Light {
  Color diffuse, highlight;
};
inline Light operator+(const Light& a, const Light& b) { return {a.diffuse + b.diffuse, a.highlight + b.highlight}; }
inline Light operator*(double s, const Light& a) { return {s * a.diffuse, s * a.highlight}; }

/// One of kPhases estimates whose mean is the light: each takes its own few points of the lamps and directions of the
/// ambient. Neighbouring pixels take different phases and are averaged afterwards.
inline constexpr int kPhases = 16;
Light light_at(const Scene& scene, Vec3 p, Vec3 normal, Vec3 towards_eye, int phase);

}  // namespace duo::synthetic
