#include "sources/synthetic/light.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "sources/synthetic/noise.h"

namespace duo::synthetic {
namespace {

constexpr int kPanelSamples = 1, kSunSamples = 1, kAmbientSamples = 2;
constexpr double kAmbientReach_m = 0.9;  // farther surfaces do not darken a corner

struct Sample {
  double u, v;  // evenly spread over the square [-1, 1)
  double x, y;  // evenly spread over the unit disc
};

// The k-th of an endless sequence that covers the square evenly.
// Source  Roberts, "The unreasonable effectiveness of quasirandom sequences", 2018 (R2)
Sample make_sample(int k) {
  const double a = fract(0.5 + k * 0.7548776662466927), b = fract(0.5 + k * 0.5698402909980532);
  const double r = std::sqrt(a);
  return {2 * a - 1, 2 * b - 1, r * cos_turns(b), r * sin_turns(b)};
}

const std::array<Sample, kPhases * 3>& samples() {
  static const auto made = [] {
    std::array<Sample, kPhases * 3> all{};
    for (int k = 0; k < kPhases * 3; ++k) all[k] = make_sample(k);
    return all;
  }();
  return made;
}

bool is_bright(Color power) { return power.r > 0 || power.g > 0 || power.b > 0; }

struct Axes {
  Vec3 u, v;
};
Axes across(Vec3 n) {
  const Vec3 u = normalized(std::abs(n.y) < 0.9 ? cross({0, 1, 0}, n) : cross({1, 0, 0}, n));
  return {u, cross(n, u)};
}

// Blinn's highlight with the exponent 64.
double highlight(Vec3 n, Vec3 towards_light, Vec3 towards_eye) {
  const double c = std::max(0.0, dot(n, normalized(towards_light + towards_eye)));
  const double c2 = c * c, c4 = c2 * c2, c8 = c4 * c4, c16 = c8 * c8, c32 = c16 * c16;
  return c32 * c32;
}

}  // namespace

Light light_at(const Scene& scene, Vec3 p, Vec3 n, Vec3 towards_eye, int phase) {
  const Vec3 from = p + scene.lift_m * n;
  Light sum;
  for (const Panel& panel : scene.panels)
    for (int i = 0; i < kPanelSamples; ++i) {
      const Sample& s = samples()[phase * kPanelSamples + i];
      const Vec3 way = panel.centre_m + s.u * panel.u_m + s.v * panel.v_m - from;
      const double rr = dot(way, way), facing = dot(n, way), shining = -dot(panel.normal, way);
      if (facing <= 0 || shining <= 0 || scene.blocked({from, way})) continue;
      const double share = shining / (rr * std::sqrt(rr) * kPanelSamples);
      const Vec3 towards = (1 / std::sqrt(rr)) * way;
      sum.diffuse = sum.diffuse + (share * facing / std::sqrt(rr)) * panel.power;
      sum.highlight = sum.highlight + (share * highlight(n, towards, towards_eye)) * panel.power;
    }

  const Axes disc = across(scene.sun.towards), side = across(n);
  for (int i = 0; i < kSunSamples && is_bright(scene.sun.power); ++i) {
    constexpr double kFar_m = 20;
    const Sample& s = samples()[phase * kSunSamples + i];
    const Vec3 towards = normalized(scene.sun.towards + scene.sun.spread * (s.x * disc.u + s.y * disc.v));
    const double facing = dot(n, towards);
    if (facing <= 0 || scene.blocked({from, kFar_m * towards})) continue;
    sum.diffuse = sum.diffuse + (facing / kSunSamples) * scene.sun.power;
    sum.highlight = sum.highlight + (highlight(n, towards, towards_eye) / kSunSamples) * scene.sun.power;
  }

  // Ambient light from the cosine-weighted half-sphere, shut out by what is near.
  const Color around = mixed(scene.ambient_up, scene.ambient_down, 0.5 + 0.5 * n.y);
  for (int i = 0; i < kAmbientSamples && is_bright(around); ++i) {
    const Sample& s = samples()[phase * kAmbientSamples + i];
    const Vec3 towards = s.x * side.u + s.y * side.v + std::sqrt(std::max(0.0, 1 - s.x * s.x - s.y * s.y)) * n;
    const double reach = kAmbientReach_m * (i + 1) / kAmbientSamples;
    if (!scene.blocked({from, reach * towards})) sum.diffuse = sum.diffuse + (1.0 / kAmbientSamples) * around;
  }
  return sum;
}

}  // namespace duo::synthetic
