#include "sources/synthetic/textures.h"

#include <algorithm>
#include <cmath>

#include "sources/synthetic/figure_textures.h"
#include "sources/synthetic/noise.h"
#include "sources/synthetic/patterns.h"

namespace duo::synthetic {
namespace {

Vec3 scaled(Vec3 p, Vec3 s) { return {p.x * s.x, p.y * s.y, p.z * s.z}; }

// fbm on a lattice of `cell` metres, stretched cells allowed; the finest side decides what the sampling can hold.
double mottle(const TexturePoint& at, Vec3 cells_per_m, int octaves, std::uint32_t salt) {
  const double finest = std::max({cells_per_m.x, cells_per_m.y, cells_per_m.z});
  return fbm(scaled(at.p_m, cells_per_m), octaves, at.footprint_m * finest, at.seed + 101 * salt);
}
double mottle(const TexturePoint& at, double cells_per_m, int octaves, std::uint32_t salt) {
  return mottle(at, {cells_per_m, cells_per_m, cells_per_m}, octaves, salt);
}

// 1 inside |x| < half, 0 outside, an edge as soft as the sample is large.
double band(double x, double half, double footprint) { return 1 - smoothstep(half - footprint, half + footprint, std::abs(x)); }

// Grain along x: long fibres and growth rings cut lengthwise.
Color grain(const Material& m, const TexturePoint& at, Vec3 p, std::uint32_t piece) {
  const double f = at.footprint_m;
  const double warp = fbm(scaled(p, {1.6, 9, 9}), 3, 9 * f, piece);
  const double ring = fract(9 * warp + 14 * p.z + 6 * p.y);
  const double fibre = fbm(scaled(p, {14, 260, 260}), 2, 260 * f, piece + 1);
  const double pore = fbm(scaled(p, {9, 150, 150}), 2, 150 * f, piece + 2);
  const double dark = 0.75 * ring * ring + 0.9 * (fibre - 0.5) + (pore > 0.64 ? 0.35 : 0.0);
  return mixed(m.a, m.b, std::clamp(dark, 0.0, 1.0));
}

Color planks(const Material& m, const TexturePoint& at) {
  constexpr double kWidth_m = 0.115, kLength_m = 1.1;
  const double v = at.p_m.z / kWidth_m;
  const int row = floor_int(v);
  const double u = at.p_m.x / kLength_m + unit(hash(at.seed, row));
  const int column = floor_int(u);
  const std::uint32_t board = hash(at.seed, row, column);
  const Vec3 p = at.p_m + Vec3{5 * unit(board), 3 * unit(mix(board)), 0};
  const Color wood = (0.72 + 0.5 * unit(mix(board + 1))) * grain(m, at, p, board);
  const double across_m = std::min(fract(v), 1 - fract(v)) * kWidth_m, along_m = std::min(fract(u), 1 - fract(u)) * kLength_m;
  return (1 - 0.75 * band(std::min(across_m, along_m), 0.0014, at.footprint_m)) * wood;
}

Color wood(const Material& m, const TexturePoint& at) {
  const Vec3 h = at.half_m;
  Vec3 p = at.p_m;
  if (h.y >= h.x && h.y >= h.z)
    p = {p.y, p.z, p.x};
  else if (h.z >= h.x)
    p = {p.z, p.x, p.y};
  return grain(m, at, p + Vec3{unit(at.seed) * 3, 0, 0}, at.seed);
}

Color fabric(const Material& m, const TexturePoint& at) {
  constexpr double kThreads_per_m = 170;
  const double keep = std::clamp(2 - 6 * at.footprint_m * kThreads_per_m, 0.0, 1.0);
  // Threads in all three directions: whichever face is seen shows warp and weft.
  const double weave = floor_int(fract(at.p_m.x * kThreads_per_m / 2) * 2) +
                       floor_int(fract(at.p_m.y * kThreads_per_m / 2) * 2) +
                       floor_int(fract(at.p_m.z * kThreads_per_m / 2) * 2);
  const double over = weave == 1 || weave == 3 ? 1 : 0;
  const double heather = mottle(at, 55, 3, 1) - 0.5, wear = mottle(at, 6, 2, 2) - 0.5;
  Color c = mixed(m.a, m.b, std::clamp(0.5 + keep * 0.5 * (over - 0.5) + 1.5 * heather, 0.0, 1.0));
  if (m.scale_m > 0) {
    const double stripe = fract((at.p_m.x + 0.5 * at.p_m.z) / m.scale_m) - 0.5;
    c = mixed(c, m.c, 0.85 * band(stripe * m.scale_m, 0.16 * m.scale_m, at.footprint_m));
  }
  return (1 + 0.5 * wear) * c;
}

Color knit(const Material& m, const TexturePoint& at) {
  const double stripe = fract(at.p_m.y / m.scale_m) - 0.5;
  const Color wool = mixed(m.a, m.b, band(stripe * m.scale_m, 0.22 * m.scale_m, at.footprint_m));
  return (0.55 + 0.9 * mottle(at, {260, 130, 260}, 3, 3)) * wool;
}

Color fur(const Material& m, const TexturePoint& at) {
  const double tuft = mottle(at, 120, 3, 4), curl = mottle(at, 30, 2, 5);
  return mixed(m.b, m.a, std::clamp(0.5 + 1.6 * (tuft - 0.5) + 0.7 * (curl - 0.5), 0.0, 1.0));
}

Color checker(const Material& m, const TexturePoint& at) {
  const auto cell = [&](double x) { return floor_int(x / m.scale_m + 0.5); };
  const int x = cell(at.p_m.x), y = cell(at.p_m.y), z = cell(at.p_m.z);
  const Color c = ((x + y + z) & 1) != 0 ? m.a : m.b;
  return (0.8 + 0.4 * mottle(at, 60, 4, 6)) * c;
}

Color ball(const Material& m, const TexturePoint& at) {
  const Vec3 p = at.p_m;
  const double r = at.half_m.x, f = at.footprint_m;
  const double seam = std::min({std::abs(p.x), std::abs(p.y), std::abs(p.z)});
  const int sector = (p.x > 0 ? 1 : 0) + (p.y > 0 ? 2 : 0) + (p.z > 0 ? 4 : 0);
  const Color sectors[] = {m.a, m.b, m.c, m.a, m.b, m.c, m.a, m.b};
  Color c = (0.75 + 0.5 * mottle(at, 90, 4, 7)) * sectors[sector];
  const double dot_m = norm(Vec3{std::abs(p.x), std::abs(p.y), std::abs(p.z)} - (0.577 * r) * Vec3{1, 1, 1});
  c = mixed(c, Color{0.9F, 0.87F, 0.8F}, band(dot_m, 0.22 * r, f));
  return (1 - 0.8 * band(seam, 0.02 * r, f)) * c;
}

Color globe(const Material& m, const TexturePoint& at) {
  const Vec3 p = (1 / at.half_m.x) * at.p_m;
  const double f = at.footprint_m / at.half_m.x;
  const double height = fbm(2.1 * p + Vec3{3, 1, 2}, 6, 2.1 * f, at.seed) + 0.12 * (mottle(at, 130, 2, 8) - 0.5);
  Color c = (0.8 + 0.7 * (fbm(9 * p, 3, 9 * f, at.seed + 9) - 0.5)) * m.a;
  if (height > 0.5) c = mixed(m.b, m.c, smoothstep(0.52, 0.66, height));
  if (std::abs(height - 0.5) < 0.012) c = {0.03F, 0.03F, 0.03F};
  if (std::abs(p.y) > 0.88) c = {0.85F, 0.88F, 0.9F};
  const double parallel = fract(p.y * 4) - 0.5;
  return (1 - 0.45 * band(parallel / 4, 0.012, f)) * c;
}

Color leaf(const Material& m, const TexturePoint& at) {
  const Vec3 q{at.p_m.x / at.half_m.x, at.p_m.y / at.half_m.y, at.p_m.z / at.half_m.z};
  const double f = at.footprint_m / at.half_m.x;
  const double rib = band(q.x, 0.05, f), veins = band(fract(7 * q.y + 2.5 * std::abs(q.x)) - 0.5, 0.1, 4 * f);
  const double blotch = mottle(at, 90, 3, 10);
  const double light = std::clamp(0.2 + 0.5 * rib + 0.3 * veins + 1.1 * (blotch - 0.5) + 0.5 * unit(at.seed), 0.0, 1.0);
  return mixed(m.b, m.a, light);
}

Color speckle(const Material& m, const TexturePoint& at) {
  const double grains = mottle(at, 170, 2, 11), cloud = mottle(at, 12, 3, 12);
  const Color c = (0.75 + 0.5 * cloud) * m.a;
  return mixed(c, m.b, smoothstep(0.6, 0.68, grains));
}

Color curtain(const Material& m, const TexturePoint& at) {
  const double motif = mottle(at, {26, 13, 26}, 2, 13), thread = mottle(at, {220, 60, 220}, 2, 14);
  return (0.7 + 0.6 * thread) * mixed(m.a, m.b, smoothstep(0.54, 0.58, motif));
}

Color sky(const Material& m, const TexturePoint& at) {
  const double foliage = mottle(at, 5, 5, 15), edge = 0.25 + 0.35 * mottle(at, 2.5, 3, 16);
  const double green = smoothstep(-0.03, 0.03, at.p_m.y / at.half_m.y + 0.45 - edge);
  return mixed((1.1 - 0.2 * foliage) * m.a, (0.2 + 0.9 * foliage) * m.b, green);
}

}  // namespace

Color texture(const Material& m, const TexturePoint& at) {
  switch (m.texture) {
    case Texture::kPaint:
      return (0.985 + 0.03 * mottle(at, 3, 2, 0)) * m.a;
    case Texture::kWallpaper:
      return wallpaper(m, at);
    case Texture::kPlanks:
      return planks(m, at);
    case Texture::kWood:
      return wood(m, at);
    case Texture::kRug:
      return rug(m, at);
    case Texture::kFabric:
      return fabric(m, at);
    case Texture::kKnit:
      return knit(m, at);
    case Texture::kFur:
      return fur(m, at);
    case Texture::kChecker:
      return checker(m, at);
    case Texture::kBall:
      return ball(m, at);
    case Texture::kGlobe:
      return globe(m, at);
    case Texture::kLeaf:
      return leaf(m, at);
    case Texture::kSpeckle:
      return speckle(m, at);
    case Texture::kBook:
      return book(m, at);
    case Texture::kPoster:
      return poster(m, at);
    case Texture::kCurtain:
      return curtain(m, at);
    case Texture::kSky:
      return sky(m, at);
    case Texture::kSkin:
      return skin(m, at);
    case Texture::kFace:
      return face(m, at);
    case Texture::kHair:
      return hair(m, at);
    case Texture::kPrint:
      return print(m, at);
    case Texture::kStripes:
      return stripes(m, at);
    case Texture::kPlaid:
      return plaid(m, at);
    case Texture::kDenim:
      return denim(m, at);
  }
  return {};
}

}  // namespace duo::synthetic
