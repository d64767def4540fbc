#include "sources/synthetic/room.h"

#include <array>

#include "sources/synthetic/furniture.h"
#include "sources/synthetic/noise.h"

namespace duo::synthetic {
namespace {

constexpr double kCeiling_m = -1.4, kLeft_m = -1.75, kRight_m = 1.9, kBack_m = 3.45, kFront_m = -1.2;
constexpr double kWindowTop_m = -0.98, kWindowSill_m = 0.12, kWindowNear_m = 1.55, kWindowFar_m = 2.85;

// Colours that go together; the seed picks one set.
struct Palette {
  std::uint32_t paper, motif, stripes, plaster, sofa_a, sofa_b, sofa_stripe, rug_a, rug_b, rug_c, curtain_a, curtain_b, accent;
};
constexpr std::array<Palette, 4> kPalettes = {{
    {0xd9d2bd, 0x7f9a8b, 0xb8ab8a, 0xe4dcc8, 0x37566b, 0x5a7d92, 0, 0x8a2f2a, 0x22304a, 0xd9c08a, 0xb8653f, 0xe0b07a, 0xd9772b},
    {0xcfd8d8, 0x5c7f96, 0x9fb3b8, 0xe6e3dc, 0x9a5a3a, 0xbd7d55, 0, 0x2f4a5f, 0x8f3b30, 0xd8cbb0, 0x55707c, 0xa9c0c4, 0xc8442f},
    {0xe0d0b8, 0xa86a4f, 0xc8a886, 0xe8e0d0, 0x4a6044, 0x71875f, 0, 0x5a3326, 0x2f5248, 0xe0c79a, 0x7d8a4f, 0xc9c78c, 0xe0a030},
    {0xd4cede, 0x6d5f8f, 0xb0a5c0, 0xe5e2e4, 0x6e6a64, 0x979188, 0, 0x3f3a55, 0x94563f, 0xd6cdb8, 0x8d5f78, 0xd0a9b8, 0x2f8f8a},
}};

// Random numbers are drawn inside braces or in statements of their own, never in two arguments of one call: compilers are
// free in the order of arguments, and the room must not depend on the compiler.
struct Place {
  Vec3 where_m;
  double turned_degrees = 0;
};

// Everything that the builders below share.
struct Build {
  Scene& scene;
  Random& random;
  const Palette& palette;
  int wood_light, wood_dark, metal, plaster, white;

  Group at(const Place& place) const { return {scene, {about_y(place.turned_degrees), place.where_m}}; }
  double jitter(double reach) const { return random.uniform(-reach, reach); }
};

void add_walls(const Build& b) {
  constexpr double kThick_m = 0.1;
  const double middle = (kFloor_m + kCeiling_m) / 2, half = (kFloor_m - kCeiling_m) / 2, mid_z = (kBack_m + kFront_m) / 2,
               half_z = (kBack_m - kFront_m) / 2, mid_x = (kLeft_m + kRight_m) / 2, half_x = (kRight_m - kLeft_m) / 2;
  const int planks = b.scene.add({.texture = Texture::kPlanks, .a = srgb(0xb98a5a), .b = srgb(0x5f3c22), .gloss = 0.12});
  const int paper = b.scene.add({.texture = Texture::kWallpaper,
                                 .a = srgb(b.palette.paper),
                                 .b = srgb(b.palette.motif),
                                 .c = srgb(b.palette.stripes),
                                 .scale_m = b.random.uniform(0.19, 0.27)});
  const Group room = b.at({});
  room.box({mid_x, kFloor_m + kThick_m, mid_z}, {half_x + 0.2, kThick_m, half_z + 0.2}, planks);
  room.box({mid_x, kCeiling_m - kThick_m, mid_z}, {half_x + 0.2, kThick_m, half_z + 0.2}, b.white);
  room.box({mid_x, middle, kBack_m + kThick_m}, {half_x + 0.2, half, kThick_m}, paper);
  room.box({mid_x, middle, kFront_m - kThick_m}, {half_x + 0.2, half, kThick_m}, b.plaster);
  room.box({kRight_m + kThick_m, middle, mid_z}, {kThick_m, half, half_z + 0.2}, b.plaster);
  // The left wall leaves the window open.
  const auto wall = [&](double top, double bottom, double near, double far) {
    room.box({kLeft_m - kThick_m, (top + bottom) / 2, (near + far) / 2}, {kThick_m, (bottom - top) / 2, (far - near) / 2},
             b.plaster);
  };
  wall(kCeiling_m, kFloor_m, kFront_m - 0.2, kWindowNear_m);
  wall(kCeiling_m, kFloor_m, kWindowFar_m, kBack_m + 0.2);
  wall(kCeiling_m, kWindowTop_m, kWindowNear_m, kWindowFar_m);
  wall(kWindowSill_m, kFloor_m, kWindowNear_m, kWindowFar_m);
  room.box({mid_x, kFloor_m - 0.045, kBack_m - 0.008}, {half_x, 0.045, 0.008}, b.white, 0.004);
  room.box({kLeft_m + 0.008, kFloor_m - 0.045, mid_z}, {0.008, 0.045, half_z}, b.white, 0.004);
}

void add_window(const Build& b) {
  const double mid_y = (kWindowTop_m + kWindowSill_m) / 2, half_y = (kWindowSill_m - kWindowTop_m) / 2;
  const double mid_z = (kWindowNear_m + kWindowFar_m) / 2, half_z = (kWindowFar_m - kWindowNear_m) / 2;
  const Group frame = b.at({{kLeft_m - 0.05, mid_y, mid_z}});
  for (const double s : {-1.0, 0.0, 1.0}) frame.box({0, 0, s * (half_z - 0.02)}, {0.025, half_y, 0.02}, b.white);
  for (const double s : {-1.0, -0.25, 1.0}) frame.box({0, s * (half_y - 0.02), 0}, {0.025, 0.02, half_z}, b.white);
  frame.box({0.1, half_y + 0.012, 0}, {0.13, 0.014, half_z + 0.06}, b.white, 0.006);
  const int garden = b.scene.add({.texture = Texture::kSky, .a = srgb(0xdfeaf5), .b = srgb(0x6f8a4f), .emission = 1.5});
  frame.box({-0.2, 0, 0}, {0.01, half_y + 0.6, half_z + 0.6}, garden);
  b.scene.shapes.back().casts_shadow = false;

  const int curtain =
      b.scene.add({.texture = Texture::kCurtain, .a = srgb(b.palette.curtain_a), .b = srgb(b.palette.curtain_b)});
  constexpr int kFolds = 7;
  constexpr double kFold_m = 0.026;
  for (int i = 0; i < kFolds; ++i) {
    const double deep = (i & 1) != 0 ? 0.03 : 0;
    const double half = (kFloor_m - kWindowTop_m) / 2 + 0.02;
    b.at({{kLeft_m + 0.08 + deep, kFloor_m - half - 0.02, kWindowFar_m + 0.02 + 1.5 * kFold_m * i}})
        .add(Frustum{half, kFold_m, 1.15 * kFold_m}, {}, curtain);
  }
  const Group rod = b.at({{kLeft_m + 0.09, kWindowTop_m - 0.05, 0}});
  rod.limb({0, 0, kWindowNear_m - 0.4}, {0, 0, kWindowFar_m + 0.4}, 0.012, b.metal);
}

void add_lights(const Build& b) {
  // The window gives soft light from the sky, the sun comes through it on to the floor, the ceiling sends light back.
  b.scene.panels.push_back({{kLeft_m + 0.01, (kWindowTop_m + kWindowSill_m) / 2, (kWindowNear_m + kWindowFar_m) / 2},
                            {0, (kWindowSill_m - kWindowTop_m) / 2, 0},
                            {0, 0, (kWindowFar_m - kWindowNear_m) / 2},
                            {1, 0, 0},
                            {1.5F, 1.65F, 1.85F}});
  b.scene.panels.push_back({{0.2, kCeiling_m + 0.01, 1.0}, {0.7, 0, 0}, {0, 0, 0.6}, {0, 1, 0}, {1.7F, 1.55F, 1.33F}});
  b.scene.sun = {normalized({-0.78, -0.6 + b.jitter(0.04), -0.12 + b.jitter(0.12)}), 0.012, {2.8F, 2.35F, 1.75F}};
  b.scene.ambient_up = {0.34F, 0.34F, 0.35F};
  b.scene.ambient_down = {0.22F, 0.19F, 0.165F};
}

void add_back(const Build& b) {
  const Palette& p = b.palette;
  const int sofa = b.scene.add({.texture = Texture::kFabric, .a = srgb(p.sofa_a), .b = srgb(p.sofa_b), .scale_m = 0});
  const int striped = b.scene.add(
      {.texture = Texture::kFabric, .a = srgb(0xe0d6c0), .b = srgb(0xc9bda2), .c = srgb(p.accent), .scale_m = 0.07});
  const int checked = b.scene.add({.texture = Texture::kChecker, .a = srgb(p.curtain_b), .b = srgb(p.rug_b), .scale_m = 0.055});
  const double sofa_x = -0.5 + b.jitter(0.06);
  const Group couch = b.at({{sofa_x, kFloor_m, kBack_m - 0.5}, b.jitter(3)});
  add_sofa(couch, 1.55, sofa, striped, checked);
  const int fur = b.scene.add({.texture = Texture::kFur, .a = srgb(0xc08a4e), .b = srgb(0x70451f)});
  const int snout = b.scene.add({.texture = Texture::kFur, .a = srgb(0xe8cfa0), .b = srgb(0xb8945f)});
  const int eyes = b.scene.add({.a = srgb(0x15100c), .gloss = 0.8});
  const int bow = b.scene.add({.texture = Texture::kFabric, .a = srgb(0xb02030), .b = srgb(0xd04050), .scale_m = 0});
  const double teddy_x = 0.1 + b.jitter(0.05), teddy_turned = b.jitter(15) - 8;
  add_teddy(couch.at({teddy_x, -0.44, -0.04}, about_y(teddy_turned) * about_x(4)), 0.42, fur, snout, eyes, bow);

  add_shelf(b.at({{0.86 + b.jitter(0.03), kFloor_m, kBack_m - 0.16}}), b.random, b.wood_dark);
  const int shade =
      b.scene.add({.texture = Texture::kFabric, .a = srgb(0xf4e2b8), .b = srgb(0xe8cf98), .scale_m = 0, .emission = 0.45});
  add_floor_lamp(b.at({{-1.42, kFloor_m, kBack_m - 0.2}}), 1.5, b.metal, shade);

  const std::array<std::uint32_t, 4> sky = {0xf2c879, 0x8fb8c8, 0xe8b0a0, 0xd8d0a8},
                                     hills = {0xb8503a, 0x2f5a70, 0x7a4a78, 0x4f7a58};
  const int k = b.random.pick(4);
  const int art =
      b.scene.add({.texture = Texture::kPoster, .a = srgb(sky[k]), .b = srgb(hills[k]), .c = srgb(0xf8ecc8), .gloss = 0.03});
  const Group picture = b.at({{sofa_x + 0.02 + b.jitter(0.1), -0.37, kBack_m - 0.012}});
  picture.box({}, {0.3, 0.37, 0.008}, art);
  for (const double s : {-1.0, 1.0}) {
    picture.box({s * 0.307, 0, -0.004}, {0.012, 0.389, 0.016}, b.wood_dark);
    picture.box({0, s * 0.377, -0.004}, {0.319, 0.012, 0.016}, b.wood_dark);
  }
}

void add_rug(const Build& b) {
  const Palette& p = b.palette;
  const int rug = b.scene.add({.texture = Texture::kRug, .a = srgb(p.rug_a), .b = srgb(p.rug_b), .c = srgb(p.rug_c)});
  b.at({{-0.2 + b.jitter(0.1), kFloor_m, 2.15}, b.jitter(5)}).box({0, -0.006, 0}, {0.95, 0.006, 0.6}, rug, 0.005);
}

void add_middle(const Build& b, double t_s) {
  const Palette& p = b.palette;
  const Group table = b.at({{-0.3 + b.jitter(0.06), kFloor_m, 2.1 + b.jitter(0.05)}, b.jitter(10)});
  add_table(table, {0.84, 0.4, 0.46}, b.wood_light);
  const int map =
      b.scene.add({.texture = Texture::kGlobe, .a = srgb(0x3f7fa8), .b = srgb(0x7f9a4f), .c = srgb(0xc9a66a), .gloss = 0.35});
  constexpr double kTurn_degrees_per_s = 25;
  add_globe(table.at({-0.2, -0.4, 0.03}), 0.105, 40 + 90 * b.random.uniform(0, 4) + kTurn_degrees_per_s * t_s, map, b.metal);
  const int glaze = b.scene.add({.texture = Texture::kSpeckle, .a = srgb(p.accent), .b = srgb(0x2a2420), .gloss = 0.4});
  const int coffee = b.scene.add({.a = srgb(0x2c1a10), .gloss = 0.2});
  add_books(table.at({0.12, -0.4, 0.02}, about_y(20 + b.jitter(20))), b.random, 3);
  add_mug(table.at({0.32, -0.4, -0.1}, about_y(40 + b.jitter(60))), glaze, coffee);

  const int cushion = b.scene.add({.texture = Texture::kKnit, .a = srgb(p.accent), .b = srgb(p.paper), .scale_m = 0.03});
  add_chair(b.at({{0.47 + b.jitter(0.04), kFloor_m, 1.9 + b.jitter(0.05)}, 140 + b.jitter(14)}), b.wood_dark, cushion);

  const int beach =
      b.scene.add({.texture = Texture::kBall, .a = srgb(0xc83a32), .b = srgb(0xe8c23c), .c = srgb(0x2f6fae), .gloss = 0.3});
  const double r = 0.13;
  const double rolled = b.jitter(60), spun = b.jitter(80);
  b.at({{-0.98 + b.jitter(0.05), kFloor_m - r, 2.0 + b.jitter(0.06)}})
      .add(Ellipsoid{{r, r, r}}, {}, beach, about_z(rolled) * about_x(30) * about_y(spun));
  const int cardboard = b.scene.add({.texture = Texture::kChecker, .a = srgb(0xb89060), .b = srgb(0x3f5a4a), .scale_m = 0.07});
  b.at({{0.62 + b.jitter(0.03), kFloor_m, 2.75}, 28 + b.jitter(12)}).box({0, -0.14, 0}, {0.16, 0.14, 0.13}, cardboard, 0.01);
}

void add_side_table(const Build& b) {
  // A side table at the lower left, with a plant: the nearest things, and thin ones.
  const Group side = b.at({{-0.52 + b.jitter(0.02), kFloor_m, 1.08 + b.jitter(0.02)}, 12 + b.jitter(8)});
  add_table(side, {0.42, 0.62, 0.36}, b.wood_dark);
  const int pot = b.scene.add({.texture = Texture::kSpeckle, .a = srgb(0xb5643c), .b = srgb(0xe6c7a0), .gloss = 0.1});
  const int soil = b.scene.add({.texture = Texture::kFur, .a = srgb(0x4a3424), .b = srgb(0x1c120b)});
  const int leaf = b.scene.add({.texture = Texture::kLeaf, .a = srgb(0x8fc060), .b = srgb(0x2f5f2c), .gloss = 0.25});
  const int stem = b.scene.add({.a = srgb(0x5f7f3a)});
  add_plant(side.at({-0.04, -0.62, 0.02}, about_y(b.jitter(180))), b.random, 0.4, pot, soil, leaf, stem);
}

void add_pendulum(const Build& b, double t_s) {
  // A ball swings on a string from the ceiling: a physical pendulum's period for its length.
  constexpr double kString_m = 1.28, kRadius_m = 0.085, kPeriod_s = 2.27, kSwing_degrees = 9;
  const double start = b.random.uniform(0, 1);
  const Group hung = b.at({{0.14 + b.jitter(0.03), kCeiling_m, 1.3 + b.jitter(0.04)}, 25})
                         .at({}, about_z(kSwing_degrees * sin_turns(start + t_s / kPeriod_s)));
  const int wool = b.scene.add(
      {.texture = Texture::kBall, .a = srgb(0x2f8f8a), .b = srgb(0xf0e4c8), .c = srgb(b.palette.accent), .gloss = 0.15});
  const int string = b.scene.add({.a = srgb(0xe8e0d0)});
  hung.limb({0, 0, 0}, {0, kString_m - kRadius_m, 0}, 0.002, string);
  hung.add(Ellipsoid{{kRadius_m, kRadius_m, kRadius_m}}, {0, kString_m, 0}, wool, about_y(35) * about_x(20));
}

}  // namespace

Rigid3 world_from_rig(std::uint32_t seed) {
  Random random(seed ^ 0x5eedU);
  const double aside = -8 + random.uniform(-1.5, 1.5), down = -7 + random.uniform(-1, 1);
  return {about_y(aside) * about_x(down), {}};
}

Scene living_room(std::uint32_t seed, double t_s, Floor floor) {
  Scene scene;
  Random random(seed);
  const Palette& palette = kPalettes[(seed - 1) % kPalettes.size()];
  const Build build{scene,
                    random,
                    palette,
                    scene.add({.texture = Texture::kWood, .a = srgb(0xcaa06a), .b = srgb(0x7d5630), .gloss = 0.12}),
                    scene.add({.texture = Texture::kWood, .a = srgb(0x8a5a38), .b = srgb(0x3a2212), .gloss = 0.15}),
                    scene.add({.a = srgb(0x4a4a4e), .gloss = 0.6}),
                    scene.add({.a = srgb(palette.plaster)}),
                    scene.add({.a = srgb(0xeeebe4), .gloss = 0.05})};
  add_walls(build);
  add_window(build);
  add_lights(build);
  add_back(build);
  add_rug(build);
  if (floor == Floor::kFurnished) add_middle(build, t_s);
  add_side_table(build);
  if (floor == Floor::kFurnished) add_pendulum(build, t_s);
  scene.ready();
  return scene;
}

}  // namespace duo::synthetic
