#include "duoptic/synthetic.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <vector>

#include "duoptic/statistics.h"
#include "sources/synthetic/lens.h"
#include "sources/synthetic/noise.h"
#include "sources/synthetic/render.h"
#include "sources/synthetic/room.h"

namespace duo {
namespace {

using namespace synthetic;

double gray(const Rgb8& p) { return 0.299 * p.r + 0.587 * p.g + 0.114 * p.b; }

// Gray value between pixels; (x, y) must lie inside.
double sampled(const Image<Rgb8>& picture, double x, double y) {
  const int x0 = std::clamp(static_cast<int>(x), 0, std::max(picture.width() - 2, 0)),
            x1 = std::min(x0 + 1, picture.width() - 1);
  const int y0 = std::clamp(static_cast<int>(y), 0, std::max(picture.height() - 2, 0)),
            y1 = std::min(y0 + 1, picture.height() - 1);
  const double u = x - x0, v = y - y0;
  return (gray(picture.at(y0, x0)) * (1 - u) + gray(picture.at(y0, x1)) * u) * (1 - v) +
         (gray(picture.at(y1, x0)) * (1 - u) + gray(picture.at(y1, x1)) * u) * v;
}

template <class T>
bool same_bits(const Image<T>& a, const Image<T>& b) {
  if (!(a.size() == b.size())) return false;
  for (int y = 0; y < a.height(); ++y)
    if (std::memcmp(a.row(y), b.row(y), sizeof(T) * static_cast<std::size_t>(a.width())) != 0) return false;
  return true;
}

bool same_bits(const SyntheticPair& a, const SyntheticPair& b) {
  return same_bits(a.pair.left.pixels, b.pair.left.pixels) && same_bits(a.pair.right.pixels, b.pair.right.pixels) &&
         same_bits(a.depth_left_m, b.depth_left_m) && same_bits(a.disparity_px, b.disparity_px) &&
         same_bits(a.seen_by_both, b.seen_by_both);
}

// --- Shapes, by hand ---------------------------------------------------------------------------------------------------

constexpr Ray kAhead{{0, 0, -2}, {0, 0, 1}};

TEST(SyntheticShapes, EnteredWhereGeometrySays) {
  EXPECT_DOUBLE_EQ(intersect(Box{{1, 1, 0.5}}, kAhead, 0), 1.5);
  EXPECT_DOUBLE_EQ(intersect(Ellipsoid{{1, 1, 0.25}}, kAhead, 0), 1.75);
  EXPECT_DOUBLE_EQ(intersect(Capsule{1, 0.5}, kAhead, 0), 1.5);
  EXPECT_DOUBLE_EQ(intersect(Frustum{1, 0.2, 0.6}, kAhead, 0), 1.6);  // the middle of the cone: radius 0.4
  // From above, on to the ends: t counts lengths of the direction, here 2.
  const Ray down{{0.1, -5, 0}, {0, 2, 0}};
  EXPECT_DOUBLE_EQ(intersect(Frustum{1, 0.2, 0.6}, down, 0), 2.0);
  EXPECT_NEAR(intersect(Capsule{1, 0.5}, down, 0), (4 - std::sqrt(0.24)) / 2, 1e-12);
  EXPECT_EQ(intersect(Frustum{1, 0.05, 0.08}, down, 0), kNever);
}

TEST(SyntheticShapes, RoundedEdgeLiesOnItsCircle) {
  // Along the diagonal of the edge at x = -1, z = -1 rounded with 0.2: the circle's centre is (-0.8, -0.8).
  const Box box{{1, 1, 1}, 0.2};
  const double h = std::sqrt(0.5);
  EXPECT_NEAR(intersect(box, {{-3, 0, -3}, {h, 0, h}}, 0), 2.2 / h - 0.2, 1e-6);
  EXPECT_NEAR(intersect(box, {{0.3, 0.1, -3}, {0, 0, 1}}, 0), 2, 1e-12);
  const Vec3 n = normal_at(box, {-0.8 - 0.2 * h, 0, -0.8 - 0.2 * h});
  EXPECT_NEAR(n.x, -h, 1e-9);
  EXPECT_NEAR(n.z, -h, 1e-9);
}

TEST(SyntheticShapes, AreNotSeenFromInsideOrBehind) {
  const Solid solids[] = {Box{{1, 1, 1}}, Box{{1, 1, 1}, 0.3}, Ellipsoid{{1, 2, 1}}, Capsule{1, 0.5}, Frustum{1, 0.7, 0.9}};
  for (const Solid& solid : solids) {
    EXPECT_EQ(intersect(solid, {{0, 0, 0}, {0.1, 0.2, 1}}, 0), kNever);
    EXPECT_EQ(intersect(solid, {{0, 0, 5}, {0.1, 0.2, 1}}, 0), kNever);
    EXPECT_EQ(intersect(solid, {{5, 0, 0}, {0, 0, 1}}, 0), kNever);
  }
}

// The tree of boxes must find what a look at every shape finds.
TEST(SyntheticScene, TreeFindsTheNearestShape) {
  const Scene scene = living_room(3, 0);
  Random random(5);
  for (int i = 0; i < 3000; ++i) {
    const Ray ray{{random.uniform(-1, 1), random.uniform(-1, 0.9), random.uniform(-0.5, 0.7)},
                  {random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-0.3, 1)}};
    double want = kNever;
    for (int s = 0; s < static_cast<int>(scene.shapes.size()); ++s) want = std::min(want, scene.trace(ray, s));
    ASSERT_EQ(scene.trace(ray).t, want) << i;
    ASSERT_NE(want, kNever) << "the room has a hole";
  }
}

TEST(SyntheticNoise, SineIsTheSine) {
  for (int i = -1000; i <= 1000; ++i) EXPECT_NEAR(sin_turns(i / 360.0), std::sin(i * 3.141592653589793 / 180), 1e-12);
}

// --- Cameras -----------------------------------------------------------------------------------------------------------

TEST(SyntheticLens, DistortsByTheFormula) {
  Camera camera{{640, 480}, 500, 400, 320, 240, {-0.1, 0.02, 0.001, -0.002, 0.005}};
  // x = 0.3, y = -0.4: r2 = 0.25, radial = 1 - 0.025 + 0.00125 + 0.000078125 = 0.976328125;
  // dx = 2 p1 x y + p2 (r2 + 2 x^2) = -0.00024 - 0.00086; dy = p1 (r2 + 2 y^2) + 2 p2 x y = 0.00057 + 0.00048.
  const Point2 at = project(camera, {0.3, -0.4});
  EXPECT_NEAR(at.x, 500 * (0.3 * 0.976328125 - 0.0011) + 320, 1e-9);
  EXPECT_NEAR(at.y, 400 * (-0.4 * 0.976328125 + 0.00105) + 240, 1e-9);
}

TEST(SyntheticLens, EveryPixelOfEveryRigCanBeInverted) {
  for (std::uint32_t seed = 1; seed <= 40; ++seed) {
    const Rig rig = synthetic_rig({.seed = seed});
    for (const Camera& camera : {rig.left, rig.right})
      for (int y = -1; y <= 480; y += 13)
        for (int x = -1; x <= 640; x += 13) {
          const Point2 back = project(camera, unproject(camera, {static_cast<double>(x), static_cast<double>(y)}));
          ASSERT_NEAR(back.x, x, 1e-8);
          ASSERT_NEAR(back.y, y, 1e-8);
        }
  }
}

TEST(SyntheticRig, IsMountedLikeByHand) {
  for (std::uint32_t seed = 1; seed <= 40; ++seed) {
    const Rig rig = synthetic_rig({.seed = seed});
    EXPECT_NEAR(rig.baseline_m(), 0.127, 0.006);
    const Mat3& r = rig.right_from_left.rotation;
    EXPECT_NEAR(determinant(r), 1, 1e-12);
    const double degrees = std::acos((r(0, 0) + r(1, 1) + r(2, 2) - 1) / 2) * 180 / 3.141592653589793;
    EXPECT_GT(degrees, 0.1);
    EXPECT_LT(degrees, 4);
    EXPECT_LT(rig.right_from_left.t_m.x, -0.12);
    EXPECT_FALSE(rig.left == rig.right);
    EXPECT_TRUE(check_rig(rig, "synthetic").has_value());
  }
  const Rig ideal = synthetic_rig({.ideal = true});
  EXPECT_EQ(ideal.right_from_left, (Rigid3{{}, {-0.127, 0, 0}}));
}

// --- Pictures ----------------------------------------------------------------------------------------------------------

// A wall 2 m ahead and a ball of 0.25 m around (0, 0, 1.25), seen straight: depth on paper.
TEST(SyntheticRender, DepthOfWallAndBallByHand) {
  Scene scene;
  const int paint = scene.add({.a = {0.5F, 0.5F, 0.5F}});
  scene.shapes.push_back({Box{{9, 9, 0.5}}, {{}, {0, 0, 2.5}}, paint});
  scene.shapes.push_back({Ellipsoid{{0.25, 0.25, 0.25}}, {{}, {0, 0, 1.25}}, paint});
  scene.ambient_up = scene.ambient_down = {1, 1, 1};
  scene.sun.towards = {0, -1, 0};
  scene.ready();
  Pool pool(1);
  const Camera camera{{101, 81}, 100, 100, 50, 40, {}};
  const Rendering got = render(pool, scene, camera, {});
  EXPECT_DOUBLE_EQ(got.surfaces.at(40, 50).z_m, 1.0);
  EXPECT_EQ(got.surfaces.at(40, 50).shape, 1);
  EXPECT_DOUBLE_EQ(got.surfaces.at(0, 0).z_m, 2.0);
  EXPECT_DOUBLE_EQ(got.surfaces.at(40, 85).z_m, 2.0);
  // Pixel (40, 60): ray (0.1, 0, 1); 1.01 z^2 - 2.5 z + 1.5 = 0 has the near root (2.5 - sqrt(0.19)) / 2.02.
  EXPECT_NEAR(got.surfaces.at(40, 60).z_m, (2.5 - std::sqrt(0.19)) / 2.02, 1e-12);
  // The ball ends where the ray touches it: tangent of the angle = 0.25 / sqrt(1.25^2 - 0.25^2) = 0.2041 -> 20 px.
  EXPECT_EQ(got.surfaces.at(40, 70).shape, 1);
  EXPECT_EQ(got.surfaces.at(40, 71).shape, 0);
  // Far from the ball the wall takes the whole ambient light: its colour comes out as it is, but for the mottling.
  EXPECT_NEAR(got.colors.at(2, 2).g, 0.5, 0.015);
}

TEST(SyntheticPicture, WarpedByTheTrueDisparityTheRightIsTheLeft) {
  const SyntheticSetup setup{.size = {480, 360}, .ideal = true};
  const SyntheticPair got = render_synthetic(setup, 2);
  const Rectified geometry = synthetic_rectified(setup);
  EXPECT_EQ(geometry.focal_px, 420);
  double right_shift = 0, wrong_shift = 0;
  int count = 0, off = 0, in_view = 0;
  for (int y = 0; y < 360; ++y)
    for (int x = 0; x < 480; ++x) {
      const double d = got.disparity_px.at(y, x);
      ASSERT_NEAR(d, geometry.focal_px * geometry.baseline_m / got.depth_left_m.at(y, x), 1e-4);
      ASSERT_GT(d, 0);
      ASSERT_LT(d, 96 * 480 / 640);
      in_view += x - d >= 0;
      if (got.seen_by_both.at(y, x) == 0) continue;
      ASSERT_GE(x - d, -1e-4);
      const double left = gray(got.pair.left.pixels.at(y, x)), right = sampled(got.pair.right.pixels, x - d, y);
      right_shift += std::abs(left - right);
      off += std::abs(left - right) > 40;
      wrong_shift += std::abs(left - sampled(got.pair.right.pixels, std::max(x - d - 3, 0.0), y));
      ++count;
    }
  EXPECT_GT(count, 0.75 * 480 * 360);
  EXPECT_LT(count, in_view);  // something is hidden
  EXPECT_LT(right_shift / count, 3.5);
  EXPECT_LT(off, 0.01 * count);
  EXPECT_GT(wrong_shift / count, 3 * right_shift / count);
}

// A raw pixel, taken through lens, depth and rig, lands in the raw right picture on the same spot.
TEST(SyntheticPicture, RawDepthAgreesWithTheRig) {
  const SyntheticPair got = render_synthetic({.size = {480, 360}, .seed = 2, .t_s = 0.7}, 2);
  EXPECT_TRUE(got.disparity_px.empty());
  std::vector<double> right_place, wrong_place;
  for (int y = 0; y < 360; ++y)
    for (int x = 0; x < 480; ++x) {
      const Point2 on_plane = unproject(got.rig.left, {static_cast<double>(x), static_cast<double>(y)});
      const Vec3 p = got.rig.right_from_left * (got.depth_left_m.at(y, x) * Vec3{on_plane.x, on_plane.y, 1});
      const Point2 at = project(got.rig.right, {p.x / p.z, p.y / p.z});
      if (at.x < 0 || at.y < 0 || at.x > 479 || at.y > 353) continue;
      const double left = gray(got.pair.left.pixels.at(y, x));
      right_place.push_back(std::abs(left - sampled(got.pair.right.pixels, at.x, at.y)));
      wrong_place.push_back(std::abs(left - sampled(got.pair.right.pixels, at.x, at.y + 5)));
    }
  ASSERT_GT(right_place.size(), 120000U);
  // The median passes over what the right camera cannot see; exposure, vignetting and noise differ.
  EXPECT_LT(median(right_place), 5);
  EXPECT_GT(median(wrong_place), 1.7 * median(right_place));
}

TEST(SyntheticPicture, SameBitsAgainAndWithAnyThreads) {
  for (const bool ideal : {false, true}) {
    const SyntheticSetup setup{.size = {97, 73}, .seed = 4, .t_s = 1.25, .ideal = ideal};
    const SyntheticPair one = render_synthetic(setup, 1);
    EXPECT_TRUE(same_bits(one, render_synthetic(setup, 1)));
    EXPECT_TRUE(same_bits(one, render_synthetic(setup, 2)));
    EXPECT_TRUE(same_bits(one, render_synthetic(setup, 5)));
  }
}

TEST(SyntheticPicture, SeedAndMomentChangeIt) {
  const SyntheticSetup setup{.size = {160, 120}, .ideal = true};
  const SyntheticPair first = render_synthetic(setup, 2);
  SyntheticSetup other = setup;
  other.seed = 2;
  EXPECT_FALSE(same_bits(first.depth_left_m, render_synthetic(other, 2).depth_left_m));
  other = setup;
  other.t_s = 0.5;
  const SyntheticPair later = render_synthetic(other, 2);
  EXPECT_EQ(later.pair.left.t_ns, 500'000'000);
  int moved = 0, still = 0;
  for (int y = 0; y < 120; ++y)
    for (int x = 0; x < 160; ++x) (first.depth_left_m.at(y, x) == later.depth_left_m.at(y, x) ? still : moved) += 1;
  EXPECT_GT(moved, 100);
  EXPECT_GT(still, 150 * 120);
}

TEST(SyntheticPicture, AnySize) {
  for (const Size size : {Size{1, 1}, Size{2, 1}, Size{33, 17}, Size{17, 33}}) {
    for (const bool ideal : {false, true}) {
      const SyntheticPair got = render_synthetic({.size = size, .ideal = ideal}, 2);
      EXPECT_EQ(got.pair.right.pixels.size(), size);
      for (int y = 0; y < size.height; ++y)
        for (int x = 0; x < size.width; ++x) {
          EXPECT_GT(got.depth_left_m.at(y, x), 0.5);
          EXPECT_LT(got.depth_left_m.at(y, x), 6);
        }
    }
  }
}

// The picture is exposed: neither dark nor burnt out, and its depths are those asked for, whatever the seed.
TEST(SyntheticPicture, EverySeedIsWellExposedAndInRange) {
  for (std::uint32_t seed = 1; seed <= 12; ++seed) {
    const SyntheticPair got = render_synthetic({.size = {64, 48}, .seed = seed}, 2);
    double sum = 0;
    for (int y = 0; y < 48; ++y)
      for (int x = 0; x < 64; ++x) {
        sum += gray(got.pair.left.pixels.at(y, x));
        EXPECT_GT(got.depth_left_m.at(y, x), 0.75) << seed;
        EXPECT_LT(got.depth_left_m.at(y, x), 4.1) << seed;
      }
    EXPECT_GT(sum / (64 * 48), 80) << seed;
    EXPECT_LT(sum / (64 * 48), 160) << seed;
  }
}

TEST(SyntheticPicture, HighDefinitionIsTheSameScene) {
  const SyntheticPair small = render_synthetic({.size = {160, 90}, .ideal = true}, 2);
  const SyntheticPair large = render_synthetic({.size = {1280, 720}, .ideal = true}, 2);
  // Pixel centres coincide nowhere; a pixel of the small picture covers 8x8, of which the middle four surround its centre.
  int same = 0;
  for (int y = 0; y < 90; ++y)
    for (int x = 0; x < 160; ++x)
      same += std::abs(small.depth_left_m.at(y, x) - large.depth_left_m.at(8 * y + 4, 8 * x + 4)) <
              0.01 * small.depth_left_m.at(y, x);
  EXPECT_GT(same, 0.97 * 160 * 90);
}

}  // namespace
}  // namespace duo
