#include "sources/synthetic/patterns.h"

#include <algorithm>
#include <cmath>

#include "sources/synthetic/noise.h"

namespace duo::synthetic {
namespace {

// Coverage of a shape given the signed distance to its edge (negative inside).
double ink(double distance, double footprint) { return 1 - smoothstep(-footprint, footprint, distance); }

double length(double x, double y) { return std::sqrt(x * x + y * y); }

// Leaf-shaped lens along the diagonal of the quadrant, from the origin out to `reach`.
double petal(double x, double y, double reach) {
  const double along = (x + y) * 0.70710678, across = std::abs(x - y) * 0.70710678;
  const double middle = along - reach / 2, bow = reach * 0.62;
  return length(middle, across + bow - 0.24 * reach) - bow;
}

}  // namespace

// Damask: flowers on a staggered grid, joined by stems, between faint stripes; the paper's own grain keeps repeats apart.
Color wallpaper(const Material& m, const TexturePoint& at) {
  const double w = m.scale_m, f = at.footprint_m / w;
  const double u = at.p_m.x / w, v = at.p_m.y / (1.3 * w);
  const int column = floor_int(u);
  const double stagger = (column & 1) != 0 ? 0.5 : 0;
  const int row = floor_int(v + stagger);
  const double x = fract(u) - 0.5, y = (fract(v + stagger) - 0.5) * 1.3;
  const double ax = std::abs(x), ay = std::abs(y);
  double flower = std::min(petal(ax, ay, 0.42), length(x, y) - 0.075);
  flower = std::min(flower, std::max(length(ax - 0.02, ay - 0.36) - 0.11, 0.055 - length(ax - 0.02, ay - 0.36)));
  flower = std::min(flower, length(ax - 0.33, ay - 0.05) - 0.035);
  flower = std::max(flower, 0.03 - length(x, y));
  const double stem = std::abs(ax - 0.44 + 0.8 * (ay - 0.32) * (ay - 0.32)) - 0.012;
  const double faded = 0.55 + 0.45 * unit(hash(at.seed, column, row));
  const double paper = fbm(45 * at.p_m, 4, 45 * at.footprint_m, at.seed), stain = fbm(2.5 * at.p_m, 3, 0, at.seed + 1);
  Color c = mixed(m.a, m.c, 0.6 * ink(stem, f));
  c = mixed(c, m.b, faded * ink(flower, f));
  return (0.8 + 0.28 * paper + 0.12 * stain) * c;
}

// Nested borders around a field of diamonds, knotted in wool.
Color rug(const Material& m, const TexturePoint& at) {
  const double f = at.footprint_m;
  const double ex = at.half_m.x - std::abs(at.p_m.x), ez = at.half_m.z - std::abs(at.p_m.z), edge = std::min(ex, ez);
  const double along = ex < ez ? at.p_m.z : at.p_m.x;
  Color c;
  if (edge < 0.035) {
    c = m.c;
  } else if (edge < 0.15) {
    const double zigzag = std::abs(fract(along / 0.1) - 0.5) * 0.1;
    c = mixed(m.b, m.c, ink(std::abs(edge - 0.07 - zigzag) - 0.011, f));
  } else if (edge < 0.175) {
    c = m.c;
  } else {
    const double x = fract(at.p_m.x / 0.24 + 0.5) - 0.5, z = fract(at.p_m.z / 0.24 + 0.5) - 0.5;
    const double diamond = (std::abs(x) + std::abs(z)) * 0.24;
    const int cell = floor_int(at.p_m.x / 0.24 + 0.5) + floor_int(at.p_m.z / 0.24 + 0.5);
    c = mixed(m.a, (cell & 1) != 0 ? m.b : m.c, ink(diamond - 0.085, f));
    c = mixed(c, m.a, ink(diamond - 0.055, f));
    c = mixed(c, (cell & 1) != 0 ? m.c : m.b, ink(diamond - 0.03, f));
  }
  const double pile = fbm(150 * at.p_m, 2, 150 * f, at.seed),
               dye = fbm(Vec3{3 * at.p_m.x, 0, 30 * at.p_m.z}, 3, 30 * f, at.seed + 1);
  return (0.35 + 0.8 * pile + 0.5 * dye) * c;
}

// Spine with bands, a label and lines of print; cloth cover; paper between the boards.
Color book(const Material& m, const TexturePoint& at) {
  const Vec3 h = at.half_m, p = at.p_m, n = at.normal;
  const double f = at.footprint_m;
  if (std::abs(n.y) > 0.5 || n.z > 0.5) {
    if (std::abs(p.x) < h.x - 0.003) return (0.75 + 0.5 * fbm(Vec3{700 * p.x, 4 * p.y, 20 * p.z}, 2, 700 * f, at.seed)) * m.c;
    return m.a;
  }
  const Color cloth = (0.75 + 0.5 * fbm(220 * p, 3, 220 * f, at.seed)) * m.a;
  if (n.z > -0.5) return cloth;
  const std::uint32_t style = mix(at.seed + 7);
  const double v = p.y / h.y;  // -1 top, 1 bottom
  double print =
      std::max(ink(std::abs(std::abs(v) - 0.86) * h.y - 0.003, f), ink(std::abs(std::abs(v) - 0.78) * h.y - 0.0015, f));
  const double label_at = (style & 1) != 0 ? -0.35 : 0.1, label = std::abs(v - label_at) - 0.32;
  const bool on_label = (style & 2) != 0 && label < 0;
  // Glyphs: cells of 5 x 7 mm, filled or not at random, in one or two columns along the spine.
  const double gu = p.x / 0.007, gv = p.y / 0.005;
  const bool glyph = unit(hash(at.seed, floor_int(gu), floor_int(gv))) > 0.45;
  const bool lettered = label < 0 && std::abs(p.x) < 0.6 * h.x && glyph;
  if (lettered) print = std::clamp(1.4 - f / 0.006, 0.3, 0.95);
  if ((style & 4) != 0) print = std::max(print, ink(std::abs(v - 0.6) * h.y - 0.007, f));
  return on_label ? mixed(m.c, m.a, lettered ? print : 0) : mixed(cloth, m.b, print);
}

// Sun over ranges of hills, in flat inks on grained paper, with a white margin and a caption.
Color poster(const Material& m, const TexturePoint& at) {
  const Vec3 h = at.half_m, p = at.p_m;
  const double f = at.footprint_m;
  constexpr Color kPaper{0.82F, 0.8F, 0.74F}, kInk{0.03F, 0.03F, 0.05F};
  const double grains = 0.78 + 0.44 * fbm(120 * p, 3, 120 * f, at.seed);
  const double margin = 0.03, foot = 0.1;
  if (at.normal.z > -0.5 || h.x - std::abs(p.x) < margin || p.y + h.y < margin || h.y - p.y < margin) return grains * kPaper;
  if (h.y - p.y < foot) {
    const int cell = floor_int(p.x / 0.011), word = floor_int(p.x / 0.07);
    const bool caption = std::abs(h.y - p.y - 0.066) < 0.014 && std::abs(p.x) < 0.62 * h.x;
    const bool letter =
        caption && unit(hash(at.seed, cell)) > 0.3 && fract(p.x / 0.07 + 0.3 * unit(hash(at.seed + 1, word))) > 0.15;
    return grains * (letter ? kInk : kPaper);
  }
  const double top = -h.y + margin, bottom = h.y - foot, s = (p.y - top) / (bottom - top);
  Color c = mixed(m.a, m.b, s * s);
  const double cx = (unit(mix(at.seed)) - 0.5) * h.x, sun = length(p.x - cx, p.y - top - 0.36 * (bottom - top)) - 0.3 * h.x;
  const double rays = std::abs(fract(s * 16) - 0.5) - 0.3 * s;
  if (sun < f) c = mixed(c, m.c, ink(sun, f) * (rays > 0 ? 1 : 0.55));
  for (int range = 0; range < 5; ++range) {
    const double ridge = 0.42 + 0.12 * range + 0.3 * (fbm({p.x * (3 + range) + 17 * range, 0, 0}, 5, f * 6, at.seed + 3) - 0.5);
    const Color hill = mixed(m.b, kInk, 0.25 + 0.17 * range);
    const double stripes = std::abs(fract((s - ridge) * (22 - 2 * range)) - 0.5) < 0.12 ? 0.5 : 0;
    c = mixed(c, mixed(hill, m.c, 0.35 * stripes), ink((ridge - s) * (bottom - top), f));
  }
  return grains * c;
}

}  // namespace duo::synthetic
