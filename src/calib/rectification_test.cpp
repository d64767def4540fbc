#include "calib/rectification.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace duo {
namespace {

Mat3 turned(Vec3 by_rad) {
  const double angle = norm(by_rad);
  const Vec3 k = angle > 0 ? (1 / angle) * by_rad : Vec3{1, 0, 0};
  const double c = std::cos(angle), s = std::sin(angle), v = 1 - c;
  return {{c + k.x * k.x * v, k.x * k.y * v - k.z * s, k.x * k.z * v + k.y * s, k.y * k.x * v + k.z * s, c + k.y * k.y * v,
           k.y * k.z * v - k.x * s, k.z * k.x * v - k.y * s, k.z * k.y * v + k.x * s, c + k.z * k.z * v}};
}

Rig ideal_rig() {
  Rig rig;
  rig.left = rig.right = {{640, 480}, 500, 500, 320, 240, {}};
  rig.right_from_left.t_m = {-0.1, 0, 0};
  return rig;
}

// Two webcams with ordinary lenses, mounted by hand.
Rig crooked_rig() {
  Rig rig;
  rig.left = {{640, 480}, 556, 558, 322, 236, {-0.118, 0.062, 8e-4, -1.1e-3, 0, 0, 0, 0}};
  rig.right = {{640, 480}, 551, 552, 315, 244, {-0.28, 0.09, -6e-4, 9e-4, -0.01, 0.02, 0.01, 0}};
  rig.right_from_left = {turned({0.03, -0.05, 0.04}), {-0.12, 0.004, -0.006}};
  return rig;
}

Rectification rectified(const Rig& rig) {
  auto result = make_rectification(rig, "test rig");
  EXPECT_TRUE(result) << result.error().what;
  return std::move(*result);
}

// By hand: equal ideal cameras side by side are rectified already, so the canvas is the raw picture and every pixel stays.
TEST(Rectification, IdealRigIsIdentity) {
  const Rectification r = rectified(ideal_rig());
  EXPECT_EQ(r.geometry.size, (Size{640, 480}));
  EXPECT_NEAR(r.geometry.focal_px, 500, 1e-9);
  EXPECT_NEAR(r.geometry.cx_px, 320, 1e-9);
  EXPECT_NEAR(r.geometry.cy_px, 240, 1e-9);
  EXPECT_NEAR(r.geometry.baseline_m, 0.1, 1e-12);
  for (const ResampleMap* map : {&r.left, &r.right})
    for (std::uint32_t y = 0; y < 480; ++y)
      for (std::uint32_t x = 0; x < 640; ++x) {
        // The last column and row are reached from the one before with the largest fraction.
        const std::uint32_t x0 = std::min(x, 638u), y0 = std::min(y, 478u), fx = x == 639 ? 255 : 0, fy = y == 479 ? 255 : 0;
        ASSERT_EQ(map->corner.at(int(y), int(x)), x0 << 16 | y0) << y << " " << x;
        ASSERT_EQ(map->fraction_q8.at(int(y), int(x)), fx << 8 | fy) << y << " " << x;
      }
}

// By hand: x 100 px right of the centre at d = 25 px: z = 500 * 0.1 / 25 = 2 m, x = 100 / 500 * 2 = 0.4 m.
TEST(Rectification, PointOfADisparity) {
  const Rectified geometry = rectified(ideal_rig()).geometry;
  const Vec3 p = geometry.triangulate({420, 190}, 25);
  EXPECT_NEAR(p.x, 0.4, 1e-9);
  EXPECT_NEAR(p.y, -0.2, 1e-9);
  EXPECT_NEAR(p.z, 2, 1e-9);
}

/// Whether the place is on the canvas and one of the four pixels around it has a value.
bool kept(const ResampleMap& map, Vec2 at) {
  const auto [w, h] = map.corner.size();
  if (at.x < -1e-6 || at.y < -1e-6 || at.x > w - 1 || at.y > h - 1) return false;
  for (const double y : {std::floor(at.y), std::ceil(at.y)})
    for (const double x : {std::floor(at.x), std::ceil(at.x)})
      if (map.corner.at(std::max(int(y), 0), std::max(int(x), 0)) != ResampleMap::kOutside) return true;
  return false;
}

/// Points that both raw pictures see: on one row, on the canvas, not marked outside, with the right depth.
void expect_rows_align(const Rig& rig) {
  const Rectification r = rectified(rig);
  const Lens left(rig.left), right(rig.right);
  std::mt19937 rng(7);
  const auto uniform = [&](double a, double b) { return std::uniform_real_distribution<double>(a, b)(rng); };
  int seen = 0;
  for (int i = 0; i < 20000; ++i) {
    const auto ray = left.ray_of({uniform(1, rig.left.size.width - 2), uniform(1, rig.left.size.height - 2)});
    if (!ray) continue;
    const Vec3 p_in_left_m = std::exp(uniform(std::log(0.45), std::log(50))) * *ray;
    const auto raw_left = left.pixel_of(p_in_left_m), raw_right = right.pixel_of(rig.right_from_left * p_in_left_m);
    if (!raw_left || !raw_right || raw_right->x < 1 || raw_right->y < 1 || raw_right->x > rig.right.size.width - 2 ||
        raw_right->y > rig.right.size.height - 2)
      continue;
    ++seen;
    const auto a = rectified_from_raw(r.geometry, r.geometry.rig_from_left, left, *raw_left);
    const auto b = rectified_from_raw(r.geometry, r.geometry.rig_from_right, right, *raw_right);
    ASSERT_TRUE(a && b);
    EXPECT_NEAR(a->y, b->y, 1e-6);
    ASSERT_TRUE(kept(r.left, *a)) << a->x << " " << a->y;
    ASSERT_TRUE(kept(r.right, *b)) << b->x << " " << b->y;
    const Vec3 p_in_rig_m = r.geometry.rig_from_left * p_in_left_m;
    const Vec3 found_m = r.geometry.triangulate(*a, a->x - b->x);
    EXPECT_NEAR(norm(found_m - p_in_rig_m), 0, 1e-6 * dot(p_in_rig_m, p_in_rig_m));
  }
  EXPECT_GT(seen, 2000);
}

TEST(Rectification, RowsAlignAndNothingCommonIsLost) {
  expect_rows_align(ideal_rig());
  expect_rows_align(crooked_rig());
  std::mt19937 rng(3);
  const auto uniform = [&](double a) { return std::uniform_real_distribution<double>(-a, a)(rng); };
  for (int i = 0; i < 10; ++i) {
    Rig rig = crooked_rig();
    rig.right_from_left = {turned({uniform(0.1), uniform(0.15), uniform(0.1)}),
                           {-0.15 + uniform(0.1), uniform(0.02), uniform(0.02)}};
    rig.left.cx_px += uniform(60);
    rig.right.fx_px *= 1 + uniform(0.2);
    expect_rows_align(rig);
  }
}

TEST(Rectification, RawPixelsComeBack) {
  const Rig rig = crooked_rig();
  const Rectified g = rectified(rig).geometry;
  const Lens lens(rig.right);
  for (int y = 0; y < 480; y += 7)
    for (int x = 0; x < 640; x += 7) {
      const auto canvas = rectified_from_raw(g, g.rig_from_right, lens, {double(x), double(y)});
      ASSERT_TRUE(canvas);
      const auto raw = raw_from_rectified(g, g.rig_from_right, lens, *canvas);
      ASSERT_TRUE(raw);
      EXPECT_NEAR(raw->x, x, 1e-6);
      EXPECT_NEAR(raw->y, y, 1e-6);
    }
}

// r (1 - 0.5 r^2) turns back at r = sqrt(2/3): 0.5443 is the furthest image of any ray.
TEST(Lens, SeesNothingBeyondTheTurningPoint) {
  const Lens lens(Camera{{640, 480}, 300, 300, 320, 240, {-0.5, 0, 0, 0, 0, 0, 0, 0}});
  const double turn = std::sqrt(2.0 / 3);
  EXPECT_TRUE(lens.pixel_of({turn - 0.01, 0, 1}));
  EXPECT_FALSE(lens.pixel_of({turn + 0.01, 0, 1}));
  EXPECT_FALSE(lens.pixel_of({0, 0, -1}));
  EXPECT_TRUE(lens.ray_of({320 + 300 * 0.54, 240}));
  EXPECT_FALSE(lens.ray_of({320 + 300 * 0.55, 240}));
  // The fold lies inside this picture: what is beyond it stays outside on the canvas, and the rest is still right.
  Rig rig = ideal_rig();
  rig.left = rig.right = lens.camera();
  expect_rows_align(rig);
}

TEST(Rectification, RefusesViewsThatCannotMeet) {
  const auto expect_refused = [](const Rig& rig, const std::string& part) {
    const auto result = make_rectification(rig, "my rig");
    ASSERT_FALSE(result);
    EXPECT_NE(result.error().what.find("my rig"), std::string::npos);
    EXPECT_NE(result.error().what.find(part), std::string::npos) << result.error().what;
  };
  Rig apart = ideal_rig();
  apart.right_from_left.rotation = turned({1.2, 0, 0});
  expect_refused(apart, "no common part");
  Rig wide = ideal_rig();
  wide.right_from_left.rotation = turned({0, 1.8, 0});
  expect_refused(wide, "degrees");
  Rig broken = ideal_rig();
  broken.left.fx_px = 0;
  expect_refused(broken, "focal length");
}

}  // namespace
}  // namespace duo
