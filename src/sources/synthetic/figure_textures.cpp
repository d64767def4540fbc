#include "sources/synthetic/figure_textures.h"

#include <algorithm>
#include <cmath>

#include "sources/synthetic/noise.h"

namespace duo::synthetic {
namespace {

constexpr Color kWhite{0.62F, 0.6F, 0.57F}, kBlack{0.02F, 0.015F, 0.012F};

// 1 where the signed distance to an edge is below 0, as soft as the sample is large.
double inside(double distance_m, double footprint_m) {
  const double soft = std::max(footprint_m, 3e-4);
  return 1 - smoothstep(-soft, soft, distance_m);
}

double oval(double x, double y, double half_x, double half_y) {
  const double u = x / half_x, v = y / half_y;
  return (std::sqrt(u * u + v * v) - 1) * std::min(half_x, half_y);
}

double grain(const TexturePoint& at, Vec3 per_m, int octaves, std::uint32_t salt) {
  const Vec3 p{at.p_m.x * per_m.x, at.p_m.y * per_m.y, at.p_m.z * per_m.z};
  return fbm(p, octaves, at.footprint_m * std::max({per_m.x, per_m.y, per_m.z}), 977 + salt);
}

// Folds, darker in their depth, and the weave that keeps plain cloth from being featureless.
double cloth(const TexturePoint& at) {
  const double folds = grain(at, {11, 5, 11}, 2, 1), heather = grain(at, {130, 130, 130}, 3, 2),
               wear = grain(at, {34, 34, 34}, 2, 3);
  return 0.42 + 0.38 * folds + 0.52 * heather + 0.26 * wear;
}

// Eye, lashes and brow around x = 0 with x outwards.
Color eye(Color c, const Material& m, double x, double y, double f) {
  c = mixed(c, 0.62 * m.a, 0.5 * inside(oval(x, y - 0.001, 0.021, 0.0135), 0.006));  // its hollow
  const double lid = -0.0072 + 30 * x * x, below = 0.0062 - 20 * x * x;
  const double white = inside(std::max(lid - y, y - below), f);
  Color ball = mixed(kWhite, m.b, inside(oval(x + 0.001, y + 0.0008, 0.0066, 0.0066), f));
  ball = mixed(ball, Color{0.10F, 0.16F, 0.2F}, inside(oval(x + 0.001, y + 0.0008, 0.0055, 0.0055), f));
  ball = mixed(ball, kBlack, inside(oval(x + 0.001, y + 0.0008, 0.0029, 0.0029), f));
  ball = mixed(ball, Color{1, 1, 1}, inside(oval(x - 0.001, y + 0.003, 0.0013, 0.0013), f));
  c = mixed(c, ball, white);
  const bool wide = std::abs(x) < 0.0165;
  if (wide) c = mixed(c, kBlack, 0.85 * inside(std::abs(y - lid + 0.0004) - 0.0013, f));
  const double arch = -0.0215 + 9 * (x - 0.004) * (x - 0.004), thick = 0.0034 - 0.06 * std::abs(x + 0.008);
  if (std::abs(x - 0.002) < 0.022) c = mixed(c, 0.7 * m.b, 0.9 * inside(std::abs(y - arch) - thick, f + 0.0006));
  return c;
}

// A smile; the lips part in a line whose ends are drawn up.
Color mouth(Color c, const Material& m, double x, double y, double f) {
  const double line = 0.0655 - 9 * x * x;
  const double open = 1 - (x / 0.0245) * (x / 0.0245);
  if (open <= 0) return c;
  const double upper = line - 0.0062 * open + 0.0012 * inside(std::abs(x) - 0.003, 0.002), lower = line + 0.0078 * open;
  c = mixed(c, m.c, 0.8 * inside(std::max(upper - y, y - lower), f));
  return mixed(c, kBlack, 0.75 * inside(std::abs(y - line) - 0.0011, f));
}

}  // namespace

Color skin(const Material& m, const TexturePoint& at) {
  const double blotch = grain(at, {26, 26, 26}, 2, 4), pores = grain(at, {240, 240, 240}, 2, 5);
  const Color red{m.a.r, 0.8F * m.a.g, 0.74F * m.a.b};
  return (0.84 + 0.22 * pores + 0.1 * blotch) * mixed(m.a, red, std::clamp(1.6 * (blotch - 0.35), 0.0, 1.0));
}

Color face(const Material& m, const TexturePoint& at) {
  const Vec3 p = at.p_m;
  const double f = at.footprint_m;
  Color c = skin(m, at);
  if (p.z > -0.02) return c;
  const double ax = std::abs(p.x);
  const Color flushed{m.a.r, 0.68F * m.a.g, 0.62F * m.a.b};
  c = mixed(c, flushed, 0.45 * inside(oval(ax - 0.042, p.y - 0.032, 0.024, 0.02), 0.012));
  c = mixed(c, flushed, 0.4 * inside(oval(p.x, p.y - 0.03, 0.016, 0.012), 0.008));
  const double jaw = std::max(smoothstep(0.045, 0.06, p.y) - smoothstep(0.13, 0.15, p.y), 0.0);
  const double stubble = m.scale_m * jaw * std::clamp(0.45 + 1.1 * grain(at, {190, 190, 190}, 2, 6), 0.0, 1.0);
  c = mixed(c, m.b, 0.8 * stubble);
  c = mouth(c, m, p.x, p.y, f);
  c = mixed(c, 0.35 * m.a, 0.8 * inside(oval(ax - 0.0065, p.y - 0.0415, 0.0036, 0.002), f));
  return eye(c, m, ax - 0.0315, p.y + 0.003, f);
}

Color hair(const Material& m, const TexturePoint& at) {
  const double strands = grain(at, {260, 28, 150}, 3, 7), locks = grain(at, {60, 9, 40}, 2, 8);
  return mixed(m.b, m.a, std::clamp(0.5 + 1.5 * (strands - 0.5) + 1.3 * (locks - 0.5), 0.0, 1.0));
}

// A sun over waves in a ring, on the chest; hems and collar are lighter.
Color print(const Material& m, const TexturePoint& at) {
  const double f = at.footprint_m, x = at.p_m.x, y = at.p_m.y + 1.245;
  Color c = m.a;
  if (at.p_m.z < 0 && std::abs(x) < 0.13) {
    const double r = std::sqrt(x * x + y * y);
    c = mixed(c, m.c, inside(std::abs(r - 0.088) - 0.006, f));
    if (r < 0.078) {
      const double waves = 0.012 * sin_turns(x / 0.052) + 0.012, sun = std::sqrt(x * x + (y + 0.014) * (y + 0.014));
      const double ray = std::abs(fract(8 * (x / (0.02 + std::abs(x) + std::abs(y + 0.014)))) - 0.5);
      c = mixed(c, m.b, inside(sun - 0.03, f));
      c = mixed(c, m.b, (ray < 0.25 ? 1.0 : 0.0) * inside(std::abs(sun - 0.045) - 0.007, f) * inside(y - 0.0, f));
      c = mixed(c, m.c, inside(std::abs(fract((y - waves) / 0.024) - 0.5) * 0.024 - 0.006, f) * inside(waves - 0.004 - y, f));
    }
  }
  const double hem = std::min(std::abs(at.p_m.y + 0.878), std::abs(at.p_m.y + 1.236) + (std::abs(x) > 0.25 ? 0.0 : 1.0));
  c = mixed(c, 0.6 * m.a, inside(hem - 0.0025, f));
  c = mixed(c, m.c, 0.85 * inside(1.472 + at.p_m.y, f));
  return cloth(at) * c;
}

Color stripes(const Material& m, const TexturePoint& at) {
  const double v = at.p_m.y / m.scale_m;
  const Color ink = (floor_int(v) & 3) == 0 ? m.c : m.b;
  const double edge = (std::abs(fract(v) - 0.5) - 0.22) * m.scale_m;
  return cloth(at) * mixed(m.a, ink, inside(edge, at.footprint_m));
}

Color plaid(const Material& m, const TexturePoint& at) {
  const double f = at.footprint_m, w = m.scale_m;
  // The way around the body or a sleeve, by the angle that a square has instead of a circle.
  const bool sleeve = std::abs(at.p_m.x) > 0.22;
  const double x = at.p_m.x - (sleeve ? (at.p_m.x < 0 ? -0.3 : 0.3) : 0), z = at.p_m.z;
  const double across = (sleeve ? 0.09 : 0.26) * x / (std::abs(x) + std::abs(z) + 1e-6);
  const auto bar = [&](double v) { return inside((std::abs(fract(v / w) - 0.5) - 0.23) * w, f); };
  const auto line = [&](double v) { return inside(std::abs(fract(v / w + 0.5) - 0.5) * w - 0.0035, f); };
  Color c = mixed(m.a, m.b, 0.5 * bar(across) + 0.45 * bar(at.p_m.y));
  c = mixed(c, m.c, 0.6 * std::max(line(across), line(at.p_m.y)));
  return cloth(at) * c;
}

Color denim(const Material& m, const TexturePoint& at) {
  const double threads = grain(at, {190, 70, 190}, 3, 9), worn = grain(at, {14, 6, 14}, 3, 10);
  const double twill = std::clamp(0.28 + 0.8 * (threads - 0.5) + 0.9 * (worn - 0.5), 0.0, 0.8);
  return (0.75 + 0.4 * grain(at, {12, 7, 12}, 2, 11)) * mixed(m.a, m.b, twill);
}

}  // namespace duo::synthetic
