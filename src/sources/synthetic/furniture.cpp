#include "sources/synthetic/furniture.h"

#include <array>
#include <cmath>

namespace duo::synthetic {

void Group::add(const Solid& solid, Vec3 at_m, int material, const Mat3& turn) const {
  scene_.shapes.push_back({solid, world_from_group_ * Rigid3{turn, at_m}, material});
}

void Group::box(Vec3 at_m, Vec3 half_m, int material, double rounding_m, const Mat3& turn) const {
  add(Box{half_m, rounding_m}, at_m, material, turn);
}

void Group::limb(Vec3 from_m, Vec3 to_m, double radius_m, int material) const {
  const Vec3 way = to_m - from_m, y = normalized(way);
  const Vec3 x = normalized(std::abs(y.x) < 0.9 ? cross(y, {1, 0, 0}) : cross(y, {0, 0, 1})), z = cross(x, y);
  add(Capsule{norm(way) / 2, radius_m}, 0.5 * (from_m + to_m), material, transposed(Mat3::from_rows(x, y, z)));
}

Material book_cover(Random& random) {
  constexpr std::array<std::uint32_t, 14> kCloth = {0x7a1f1f, 0x1f3a5f, 0x2f5d3a, 0x8c6a2f, 0x40304f, 0x20262e, 0xb0452c,
                                                    0x3f7f86, 0xc9b458, 0x9aa7b0, 0x6b2f45, 0xd8d2c0, 0x55702f, 0x28508a};
  const std::uint32_t cloth = kCloth[random.pick(static_cast<int>(kCloth.size()))];
  const bool pale = ((cloth >> 8) & 255) > 0x90;
  const std::uint32_t print = pale ? 0x2a1a12 : random.pick(2) == 0 ? 0xe2c060 : 0xf0ead8;
  return {.texture = Texture::kBook, .a = srgb(cloth), .b = srgb(print), .c = srgb(0xe9dfc6), .gloss = 0.04};
}

void add_table(const Group& group, Vec3 size_m, int wood) {
  const double x = size_m.x / 2, z = size_m.z / 2, leg = 0.022, apron = 0.035;
  group.box({0, -size_m.y + 0.014, 0}, {x, 0.014, z}, wood, 0.006);
  for (const double sx : {-1.0, 1.0}) {
    for (const double sz : {-1.0, 1.0})
      group.add(Frustum{(size_m.y - 0.028) / 2, leg, 0.6 * leg}, {sx * (x - 0.05), -(size_m.y - 0.028) / 2, sz * (z - 0.05)},
                wood);
    group.box({sx * (x - 0.05), -size_m.y + 0.028 + apron, 0}, {0.009, apron, z - 0.06}, wood);
    group.box({0, -size_m.y + 0.028 + apron, sx * (z - 0.05)}, {x - 0.06, apron, 0.009}, wood);
  }
}

// Faces -z; the back is a row of slats.
void add_chair(const Group& group, int wood, int cushion) {
  constexpr double kSeat_m = 0.45, kBack_m = 0.9, kHalf_m = 0.2;
  group.box({0, -kSeat_m, 0}, {kHalf_m + 0.02, 0.014, kHalf_m + 0.02}, wood, 0.008);
  group.box({0, -kSeat_m - 0.034, -0.01}, {kHalf_m - 0.01, 0.026, kHalf_m - 0.02}, cushion, 0.022);
  for (const double side : {-1.0, 1.0}) {
    group.limb({side * kHalf_m, -0.018, -kHalf_m}, {side * (kHalf_m - 0.02), -kSeat_m, -kHalf_m + 0.02}, 0.018, wood);
    group.limb({side * kHalf_m, -0.018, kHalf_m + 0.05}, {side * (kHalf_m - 0.01), -kSeat_m, kHalf_m - 0.01}, 0.018, wood);
    group.limb({side * (kHalf_m - 0.01), -kSeat_m, kHalf_m - 0.01}, {side * kHalf_m, -kBack_m, kHalf_m + 0.08}, 0.018, wood);
    group.limb({side * kHalf_m, -0.2, -kHalf_m + 0.01}, {side * kHalf_m, -0.2, kHalf_m + 0.03}, 0.01, wood);
  }
  group.limb({-kHalf_m, -0.24, 0.01}, {kHalf_m, -0.24, 0.01}, 0.01, wood);
  group.box({0, -kBack_m + 0.03, kHalf_m + 0.075}, {kHalf_m, 0.045, 0.011}, wood, 0.01, about_x(-10));
  group.box({0, -kSeat_m - 0.1, kHalf_m + 0.008}, {kHalf_m, 0.02, 0.009}, wood, 0.008, about_x(-10));
  for (int i = -2; i <= 2; ++i)
    group.limb({i * 0.066, -kSeat_m - 0.1, kHalf_m + 0.008}, {i * 0.066, -kBack_m + 0.05, kHalf_m + 0.07}, 0.0085, wood);
}

void add_sofa(const Group& group, double width_m, int fabric, int cushion_a, int cushion_b) {
  const double x = width_m / 2, arm = 0.09, seat = (x - 2 * arm) / 2;
  group.box({0, -0.19, 0.02}, {x - 0.02, 0.13, 0.38}, fabric, 0.03);
  group.box({0, -0.5, 0.33}, {x - 0.04, 0.36, 0.1}, fabric, 0.07, about_x(-7));
  for (const double side : {-1.0, 1.0}) {
    group.box({side * (x - arm), -0.33, 0}, {arm, 0.27, 0.41}, fabric, 0.07);
    group.box({side * seat, -0.37, -0.06}, {seat - 0.004, 0.075, 0.36}, fabric, 0.055);
    group.box({side * seat, -0.62, 0.2}, {seat - 0.012, 0.21, 0.085}, fabric, 0.075, about_x(-14));
    for (const double depth : {-0.3, 0.3}) group.add(Frustum{0.03, 0.025, 0.018}, {side * (x - 0.1), -0.03, depth}, fabric);
  }
  group.box({-x + 0.36, -0.58, 0.03}, {0.19, 0.19, 0.06}, cushion_a, 0.058, about_y(12) * about_x(-24) * about_z(9));
  group.box({x - 0.4, -0.56, 0.04}, {0.17, 0.17, 0.06}, cushion_b, 0.058, about_y(-16) * about_x(-26) * about_z(-38));
}

// Sits facing -z.
void add_teddy(const Group& group, double height_m, int fur, int snout, int eyes, int bow) {
  const double s = height_m;
  const auto ball = [&](Vec3 at, Vec3 radii, int material) { group.add(Ellipsoid{s * radii}, s * at, material); };
  ball({0, -0.31, 0}, {0.21, 0.28, 0.19}, fur);
  ball({0, -0.29, -0.07}, {0.15, 0.2, 0.14}, snout);
  ball({0, -0.73, -0.02}, {0.205, 0.19, 0.185}, fur);
  ball({0, -0.68, -0.18}, {0.095, 0.075, 0.08}, snout);
  ball({0, -0.705, -0.255}, {0.034, 0.026, 0.022}, eyes);
  for (const double side : {-1.0, 1.0}) {
    ball({side * 0.165, -0.89, 0}, {0.08, 0.08, 0.045}, fur);
    ball({side * 0.165, -0.885, -0.025}, {0.05, 0.05, 0.03}, snout);
    ball({side * 0.075, -0.765, -0.178}, {0.022, 0.026, 0.018}, eyes);
    group.limb(s * Vec3{side * 0.17, -0.46, -0.02}, s * Vec3{side * 0.29, -0.24, -0.17}, s * 0.075, fur);
    group.limb(s * Vec3{side * 0.12, -0.1, -0.06}, s * Vec3{side * 0.21, -0.085, -0.34}, s * 0.085, fur);
    ball({side * 0.215, -0.095, -0.405}, {0.062, 0.072, 0.03}, snout);
    group.add(Ellipsoid{s * Vec3{0.085, 0.05, 0.03}}, s * Vec3{side * 0.08, -0.545, -0.185}, bow, about_z(side * 14));
  }
  ball({0, -0.545, -0.195}, {0.03, 0.032, 0.03}, bow);
}

void add_shelf(const Group& group, Random& random, int wood) {
  constexpr double kHalf_m = 0.42, kDepth_m = 0.14, kBoard_m = 0.011, kHeight_m = 1.74;
  constexpr int kRows = 5;
  for (const double side : {-1.0, 1.0})
    group.box({side * kHalf_m, -kHeight_m / 2, 0}, {kBoard_m, kHeight_m / 2, kDepth_m}, wood);
  group.box({0, -kHeight_m / 2, kDepth_m - 0.004}, {kHalf_m, kHeight_m / 2, 0.004}, wood);
  for (int row = 0; row <= kRows; ++row) {
    const double y = -0.06 - row * (kHeight_m - 0.07) / kRows;
    group.box({0, y, 0}, {kHalf_m - kBoard_m, kBoard_m, kDepth_m - 0.002}, wood);
    if (row == kRows) break;
    double x = -kHalf_m + 0.02;
    const double stop = kHalf_m - 0.02 - (row % 2 == 0 ? random.uniform(0.02, 0.2) : 0.02);
    while (x < stop) {
      const double half_x = random.uniform(0.009, 0.023), half_y = random.uniform(0.09, 0.145),
                   half_z = random.uniform(0.07, 0.1);
      if (x + 2 * half_x > stop) break;
      const double lean = random.pick(9) == 0 ? random.uniform(3, 8) : 0;
      const double room = 2 * half_y * sin_turns(lean / 360);
      if (x + 2 * half_x + room > stop) break;
      const double inset = random.uniform(0, 0.03);
      group.box({x + half_x + room / 2, y - kBoard_m - half_y - 0.001, -kDepth_m + 0.012 + inset + half_z},
                {half_x, half_y, half_z}, group.scene().add(book_cover(random)), 0, about_z(lean));
      x += 2 * half_x + room + 0.0012 + (random.pick(16) == 0 ? 0.07 : 0);
    }
  }
}

void add_books(const Group& group, Random& random, int count) {
  double y = 0;
  for (int i = 0; i < count; ++i) {
    const double half_y = random.uniform(0.011, 0.022), half_x = random.uniform(0.095, 0.13), half_z = 0.72 * half_x;
    // The texture's spine faces -z and is as long as y: the book lies on its side.
    const Vec3 at{random.uniform(-0.012, 0.012), y - half_y, random.uniform(-0.01, 0.01)};
    const double turned = random.uniform(-14, 14);
    group.box(at, {half_y, half_x, half_z}, group.scene().add(book_cover(random)), 0, about_y(turned) * about_z(90));
    y -= 2 * half_y + 0.0005;
  }
}

void add_floor_lamp(const Group& group, double height_m, int metal, int shade) {
  group.add(Frustum{0.012, 0.12, 0.14}, {0, -0.012, 0}, metal);
  group.limb({0, -0.03, 0}, {0, -height_m + 0.15, 0}, 0.011, metal);
  group.add(Frustum{0.14, 0.11, 0.19}, {0, -height_m + 0.14, 0}, shade);
}

void add_plant(const Group& group, Random& random, double height_m, int pot, int soil, int leaf, int stem) {
  const double pot_half = 0.16 * height_m, pot_top = 0.19 * height_m;
  group.add(Frustum{pot_half, pot_top, 0.75 * pot_top}, {0, -pot_half, 0}, pot);
  group.add(Frustum{0.02 * height_m, 1.1 * pot_top, 1.1 * pot_top}, {0, -2 * pot_half, 0}, pot);
  group.add(Frustum{0.003, 0.95 * pot_top, 0.95 * pot_top}, {0, -2.13 * pot_half, 0}, soil);
  constexpr int kLeaves = 17;
  for (int i = 0; i < kLeaves; ++i) {
    // The golden angle spreads leaves as plants do; the inner ones stand higher.
    const double turn = 137.5 * i + random.uniform(-12, 12), share = (i + 0.5) / kLeaves;
    const double out = height_m * (0.1 + 0.3 * share),
                 up = height_m * (1.05 - 0.5 * share) + random.uniform(-0.04, 0.04) * height_m;
    const double half = height_m * random.uniform(0.13, 0.18), droop = 20 + 65 * share + random.uniform(-10, 10);
    const Group around = group.at({}, about_y(turn));
    const Vec3 base{0, -2 * pot_half, 0}, joint{0, -up, out};
    around.limb(base, joint, 0.007 * height_m, stem);
    // Local y of a leaf runs along it; turned about x it leans outwards.
    const Mat3 lean = about_x(180 - droop);
    around.add(Ellipsoid{{0.42 * half, half, 0.012 * height_m}}, joint + lean * Vec3{0, 0.85 * half, 0}, leaf, lean);
  }
}

void add_mug(const Group& group, int glaze, int drink) {
  constexpr double kHalf_m = 0.05, kRadius_m = 0.041;
  group.add(Frustum{kHalf_m, kRadius_m, 0.93 * kRadius_m}, {0, -kHalf_m, 0}, glaze);
  group.add(Frustum{0.001, 0.88 * kRadius_m, 0.88 * kRadius_m}, {0, -2 * kHalf_m - 0.0005, 0}, drink);
  constexpr int kPieces = 6;
  for (int i = 0; i < kPieces; ++i) {
    const auto on_handle = [&](int k) {
      const double turn = -0.25 + 0.5 * k / kPieces;
      return Vec3{kRadius_m + 0.028 * cos_turns(turn) - 0.003, -kHalf_m + 0.03 * sin_turns(turn), 0};
    };
    group.limb(on_handle(i), on_handle(i + 1), 0.0055, glaze);
  }
}

void add_globe(const Group& group, double radius_m, double turned_degrees, int map, int metal) {
  group.add(Frustum{0.012, 0.4 * radius_m, 0.55 * radius_m}, {0, -0.012, 0}, metal);
  group.limb({0, -0.02, 0}, {0, -0.05, 0}, 0.008, metal);
  const Group tilted = group.at({0, -0.06 - radius_m, 0}, about_z(23.4));
  tilted.add(Ellipsoid{{radius_m, radius_m, radius_m}}, {}, map, about_y(turned_degrees));
  tilted.limb({0, -1.12 * radius_m, 0}, {0, 1.12 * radius_m, 0}, 0.004, metal);
  constexpr int kPieces = 12;
  for (int i = 0; i < kPieces; ++i) {
    const auto on_arc = [&](int k) {
      const double turn = -0.25 + 0.5 * k / kPieces;
      return 1.12 * radius_m * Vec3{cos_turns(turn), sin_turns(turn), 0};
    };
    tilted.limb(on_arc(i), on_arc(i + 1), 0.005, metal);
  }
}

}  // namespace duo::synthetic
