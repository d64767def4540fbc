// The parts of the arm tracker on pictures small enough to know the answer.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>
#include <vector>

#include "core/rotation.h"
#include "tests/agree.h"
#include "trackers/arm/bones.h"
#include "trackers/arm/hand.h"
#include "trackers/arm/patches.h"
#include "trackers/arm/torso.h"

namespace duo::arm {
namespace {

// One cell is one pixel; a cell at 1 m is 1 cm wide.
Rectified geometry_of(Size size, double focal_px) {
  Rectified r;
  r.size = size;
  r.focal_px = focal_px;
  r.cx_px = size.width / 2.0;
  r.cy_px = size.height / 2.0;
  r.baseline_m = 0.1;
  return r;
}
Rectified geometry() { return geometry_of({100, 80}, 100); }

void fill_row(Grid& grid, int y, int begin, int end, float z_m, std::vector<std::uint8_t>& mask) {
  for (int x = begin; x < end; ++x) {
    grid.z_m[static_cast<std::size_t>(grid.at(x, y))] = z_m;
    mask[static_cast<std::size_t>(grid.at(x, y))] = 1;
  }
}

void expect_near(Vec3 a, Vec3 b, double tolerance) { EXPECT_LT(norm(a - b), tolerance) << a.x << " " << a.y << " " << a.z; }

TEST(Grid, CellHoldsMedianDisparityAndTrimmedColor) {
  const Rectified r = geometry_of({680, 480}, 600);
  Grid grid(r);
  ASSERT_EQ(grid.step, 2);
  Frame frame;
  frame.color = Image<Rgb8>(r.size);
  frame.disparity.d_q4 = Image<std::uint16_t>(r.size);
  for (int y = 0; y < 480; ++y)
    for (int x = 0; x < 680; ++x) frame.disparity.d_q4.at(y, x) = Disparity::kNone;
  // The cell (10, 20): disparities 16, 32, 32 px and one unknown; red 10, 20, 30, 200.
  frame.disparity.d_q4.at(40, 20) = 16 * 16;
  frame.disparity.d_q4.at(40, 21) = frame.disparity.d_q4.at(41, 20) = 32 * 16;
  int i = 0;
  for (const std::uint8_t red : {10, 20, 30, 200}) {
    frame.color.at(40 + i / 2, 20 + i % 2) = {red, 0, 0};
    ++i;
  }
  grid.build(frame);
  const int cell = grid.at(10, 20);
  EXPECT_FLOAT_EQ(static_cast<float>(grid.z(cell)), 600 * 0.1F / 32);
  EXPECT_FLOAT_EQ(grid.color[static_cast<std::size_t>(cell)].r, 25);
  EXPECT_EQ(grid.color_bin(cell), 31U);  // hue 0, saturation full
  EXPECT_FALSE(grid.known(grid.at(11, 20)));
  EXPECT_EQ(grid.cell_of(grid.point(cell)), cell);
}

/// Red, depth and cover of the cell (x, y), by sorting.
void expect_cell(const Frame& frame, const Grid& grid, int x, int y) {
  std::vector<int> red, d_q4;
  bool covered = true;
  for (int v = y * grid.step; v < (y + 1) * grid.step; ++v)
    for (int u = x * grid.step; u < (x + 1) * grid.step; ++u) {
      red.push_back(frame.color.at(v, u).r);
      const int d = frame.disparity.d_q4.at(v, u);
      if (d != 0 && d != Disparity::kNone) d_q4.push_back(d);
      covered &= frame.left_inside.at(v, u) != 0;
    }
  std::sort(red.begin(), red.end());
  std::sort(d_q4.begin(), d_q4.end());
  const auto cut = red.size() < 4 ? 0 : 1;
  const auto n = static_cast<float>(red.size() - 2 * static_cast<std::size_t>(cut));
  const auto i = static_cast<std::size_t>(grid.at(x, y));
  ASSERT_EQ(grid.color[i].r, static_cast<float>(std::accumulate(red.begin() + cut, red.end() - cut, 0)) / n);
  ASSERT_EQ(grid.inside[i] != 0, covered);
  const auto fb_q4 = static_cast<float>(grid.camera.focal_px * grid.step * grid.camera.baseline_m * 16);
  const bool enough = !d_q4.empty() && d_q4.size() * 4 >= red.size();
  ASSERT_EQ(grid.z_m[i], enough ? fb_q4 / static_cast<float>(d_q4[d_q4.size() / 2]) : 0) << grid.step << ": " << x << " " << y;
}

TEST(Grid, AgreesWithSortingAtEachStep) {
  std::mt19937 rng(1);
  for (const int width : {300, 673, 1021, 1361}) {
    const Rectified r = geometry_of({width, 34}, 600);
    Grid grid(r);
    Frame frame;
    frame.color = Image<Rgb8>(r.size);
    frame.disparity.d_q4 = Image<std::uint16_t>(r.size);
    frame.left_inside = Image<std::uint8_t>(r.size);
    for (int y = 0; y < 34; ++y)
      for (int x = 0; x < width; ++x) {
        frame.color.at(y, x).r = static_cast<std::uint8_t>(rng());
        const std::uint32_t unknown = rng() % 4;
        frame.disparity.d_q4.at(y, x) = unknown == 0   ? 0
                                        : unknown == 1 ? Disparity::kNone
                                                       : static_cast<std::uint16_t>(1 + rng() % 4096);
        frame.left_inside.at(y, x) = rng() % 8 != 0 ? 255 : 0;
      }
    grid.build(frame);
    for (int y = 0; y < grid.height; ++y)
      for (int x = 0; x < grid.width; ++x) expect_cell(frame, grid, x, y);
    if (HasFailure()) return;
  }
}

TEST(Regions, CutAtDepthStepsAndBridgeOneCell) {
  Grid grid(geometry());
  std::vector<std::uint8_t> mask(static_cast<std::size_t>(grid.size()));
  fill_row(grid, 10, 10, 20, 1.0F, mask);
  fill_row(grid, 10, 21, 30, 1.01F, mask);  // behind a gap of one cell
  fill_row(grid, 10, 30, 40, 1.5F, mask);   // behind a step
  fill_row(grid, 20, 10, 15, 1.0F, mask);   // too small
  Regions regions(grid);
  const auto found = regions.find(grid, mask, 0.025);
  ASSERT_EQ(found.size(), 2U);
  EXPECT_EQ(found[0].cells.size(), 19U);
  EXPECT_EQ(found[1].cells.size(), 10U);
  EXPECT_NEAR(found[1].area_m2, 10 * 0.015 * 0.015, 1e-6);
  EXPECT_NEAR(found[1].mean.x, (34.5 - 50) / 100 * 1.5, 1e-6);
}

TEST(ColorTable, RatioOfShares) {
  Histogram skin{}, cloth{};
  skin[40] = cloth[700] = 1;
  ColorTable table;
  table.start(skin, cloth);
  EXPECT_FLOAT_EQ(table(40), 4);  // log(1.0001 / 0.001) is beyond the limit
  EXPECT_FLOAT_EQ(table(700), -4);
  EXPECT_NEAR(table(100), std::log(1e-4 / 1e-3), 1e-5);
  Histogram half{};
  half[40] = half[100] = 0.5F;
  table.learn_surroundings(half, 1);
  EXPECT_NEAR(table(40), std::log(1.0001 / 0.501), 1e-5);
  for (int i = 0; i < 1000; ++i) table.learn_target(cloth, 0.5F);
  EXPECT_NEAR(table(40), std::log(0.3001 / 0.501), 1e-5);  // the first histogram keeps its share
}

TEST(ColorTable, SmoothingGoesAroundTheHueCircle) {
  Histogram counts{};
  counts[5] = 16;  // hue 0
  const Histogram h = smoothed(counts);
  EXPECT_NEAR(h[5], 4.0 / 16, 1e-6);
  EXPECT_NEAR(h[31 * 32 + 5], 2.0 / 16, 1e-6);
  EXPECT_NEAR(h[32 + 6], 1.0 / 16, 1e-6);
}

constexpr Vec3 kBack{0, 0, 1};  // the torso looks at the camera

TEST(ElbowCircle, BothBonesHaveTheirLengths) {
  const Vec3 shoulder{0.1, -0.2, 2}, hand{0.3, 0.1, 1.8};
  const ElbowCircle circle(shoulder, hand, {0.30, 0.26});
  EXPECT_EQ(circle.stretch_m, 0);
  EXPECT_GT(circle.radius_m, 0.1);
  for (const double angle : {0.0, 1.0, 2.0, 5.0}) {
    EXPECT_NEAR(norm(circle.at(angle) - shoulder), 0.30, 1e-12);
    EXPECT_NEAR(norm(circle.at(angle) - hand), 0.26, 1e-12);
  }
}

TEST(ElbowCircle, StretchedArmIsAPointOnTheLine) {
  const ElbowCircle circle({0, 0, 2}, {0.6, 0, 2}, {0.3, 0.2});
  EXPECT_NEAR(circle.stretch_m, 0.101, 1e-9);
  EXPECT_LT(circle.radius_m, 0.02);
  expect_near(circle.centre, {0.36, 0, 2}, 0.005);
}

TEST(ElbowFinder, FindsTheBentLimb) {
  // An upper arm to the right and a forearm down, 9 cells wide, 1 m away, before nothing.
  Grid grid(geometry());
  Silhouette silhouette(grid);
  std::fill(grid.inside.begin(), grid.inside.end(), std::uint8_t{1});
  for (int y = 16; y < 25; ++y) fill_row(grid, y, 30, 65, 1.0F, silhouette.front);
  for (int y = 25; y < 50; ++y) fill_row(grid, y, 56, 65, 1.0F, silhouette.front);
  const Params params;
  const Vec3 shoulder = grid.camera.unproject({30, 20}, 1.03), elbow = grid.camera.unproject({60, 20}, 1.03),
             hand = grid.camera.unproject({60, 50}, 1.02);
  const Lengths lengths{norm(elbow - shoulder), norm(hand - elbow)};
  const Vec3 wrong = elbow + Vec3{-0.06, 0.06, 0.02};
  const ElbowFinder finder(grid, silhouette, lengths, params);
  const ElbowSeen seen = finder.between(shoulder, hand, {wrong, 0.2}, kBack);
  expect_near(seen.p, elbow, 0.025);
  EXPECT_GT(seen.score, 2);
  EXPECT_LT(finder.between(shoulder, grid.camera.unproject({20, 60}, 1.02), {wrong, 0.2}, kBack).score, 0);  // nothing there
}

// The upper arm was raised while nothing held the elbow: a right angle away from where it hung.
TEST(ElbowFinder, FindsAnElbowFarFromWhereItWas) {
  Grid grid(geometry());
  Silhouette silhouette(grid);
  std::fill(grid.inside.begin(), grid.inside.end(), std::uint8_t{1});
  for (int y = 36; y < 45; ++y) fill_row(grid, y, 30, 65, 1.0F, silhouette.front);
  const Params params;
  const Vec3 shoulder = grid.camera.unproject({30, 40}, 1.03), elbow = grid.camera.unproject({60, 40}, 1.03);
  const Lengths lengths{norm(elbow - shoulder), 0.25};
  const ElbowFinder finder(grid, silhouette, lengths, params);
  const JointPrior hanging{shoulder + Vec3{0.02, lengths.upper_m, 0}, 0.35};
  const ElbowSeen anywhere = finder.anywhere(shoulder, hanging);
  expect_near(anywhere.p, elbow, 0.05);
  EXPECT_GT(anywhere.score, 1);
  EXPECT_LT(finder.near(shoulder, hanging).score, 0);
  std::fill(silhouette.front.begin(), silhouette.front.end(), std::uint8_t{0});
  EXPECT_LT(finder.anywhere(shoulder, hanging).score, 0) << "nothing there";
}

// A forearm up to the picture's upper border, 25 of its 40 cm; the hand was last seen to the side of it.
TEST(ElbowFinder, AForearmLeadsOutOfThePicture) {
  Grid grid(geometry());
  Silhouette silhouette(grid);
  std::fill(grid.inside.begin(), grid.inside.end(), std::uint8_t{1});
  for (int y = 0; y < 80; ++y) fill_row(grid, y, 0, 100, 3.0F, silhouette.front);  // a wall, which is no part of
  std::fill(silhouette.front.begin(), silhouette.front.end(), std::uint8_t{0});    // what stands in front
  for (int y = 0; y < 26; ++y) fill_row(grid, y, 47, 54, 1.0F, silhouette.front);
  const Params params;
  const Lengths lengths{0.3, 0.4};
  const ElbowFinder finder(grid, silhouette, lengths, params);
  const Vec3 elbow = grid.camera.unproject({50, 25}, 1.03);
  const auto hand = finder.hand_outside(elbow, {elbow + Vec3{0.12, -0.36, 0}, 0.15});
  ASSERT_TRUE(hand);
  expect_near(*hand, elbow + Vec3{0, -0.4, 0}, 0.08);
  // One that leads down stays in the picture.
  for (int y = 26; y < 70; ++y) fill_row(grid, y, 47, 54, 1.0F, silhouette.front);
  EXPECT_FALSE(finder.hand_outside(elbow, {elbow + Vec3{0.12, 0.36, 0}, 0.15}));
}

// Without depth the whole circle is equally likely.
TEST(ElbowFinder, TheElbowOfAHangingArmIsBehindIt) {
  Grid grid(geometry());
  const Silhouette silhouette(grid);
  const Vec3 shoulder = grid.camera.unproject({40, 15}, 1), hand = grid.camera.unproject({40, 65}, 1);
  const Lengths lengths{0.27, 0.25};
  const Params params;
  const ElbowFinder finder(grid, silhouette, lengths, params);
  const JointPrior anywhere{0.5 * (shoulder + hand), 10};
  EXPECT_GT(finder.between(shoulder, hand, anywhere, kBack).p.z, 1.02);
  EXPECT_LT(finder.between(shoulder, hand, anywhere, Vec3{0, 0, -1}).p.z, 0.98);
}

TEST(ElbowFinder, TheElbowOfAnArmHeldOutSags) {
  Grid grid(geometry());
  const Silhouette silhouette(grid);
  const Vec3 shoulder = grid.camera.unproject({20, 40}, 1), hand = grid.camera.unproject({70, 40}, 1);
  const Lengths lengths{0.27, 0.25};
  const Params params;
  const ElbowFinder finder(grid, silhouette, lengths, params);
  EXPECT_GT(finder.between(shoulder, hand, {0.5 * (shoulder + hand), 10}, kBack).p.y, shoulder.y + 0.02);
}

TEST(HandFinder, AForearmThatGoesOnBehindSomethingIsCovered) {
  Grid grid(geometry());
  std::vector<std::uint8_t> front(static_cast<std::size_t>(grid.size()));
  for (int y = 30; y < 52; ++y) fill_row(grid, y, 66, 90, 0.8F, front);  // 66: where the skin ends
  const Vec3 elbow = grid.camera.unproject({30, 40.5}, 1);
  HandSeen hand{grid.camera.unproject({56, 40.5}, 1), 0.355};
  EXPECT_EQ(covered_beyond(grid, front, elbow, hand, Params{}), 1);
  for (int y = 30; y < 52; ++y) fill_row(grid, y, 66, 90, 1.2F, front);  // the body behind the hand
  EXPECT_EQ(covered_beyond(grid, front, elbow, hand, Params{}), 0);
}

TEST(HandFinder, FarEndLessTheHandsLength) {
  // A forearm 36 cells long and 8 wide, at 1 m, from the elbow at the left.
  Grid grid(geometry());
  Silhouette silhouette(grid);
  for (int y = 37; y < 45; ++y) fill_row(grid, y, 30, 66, 1.0F, silhouette.skin);
  std::vector<int> cells;
  for (int i = 0; i < grid.size(); ++i)
    if (silhouette.skin[static_cast<std::size_t>(i)]) cells.push_back(i);
  const Params params;
  HandFinder finder(grid);
  const Vec3 elbow = grid.camera.unproject({30, 40.5}, 1);
  const auto seen = finder.find(grid, silhouette, cells, elbow, 0.25, 0.1, nullptr, params);
  ASSERT_TRUE(seen);
  EXPECT_NEAR(seen->tip_m, 0.35, 0.015);
  expect_near(seen->p, behind(grid.camera.unproject({30 + 25, 40.5}, 1), params.hand_depth_m), 0.02);
  EXPECT_NEAR(seen->area_m2, 0.19 * 0.08, 0.002);
  EXPECT_DOUBLE_EQ(seen->skin_m2, seen->area_m2);

  const Gate elsewhere{{-1, 0, 1}, 0.1};
  EXPECT_FALSE(finder.find(grid, silhouette, cells, elbow, 0.25, 0.1, &elsewhere, params));
}

// A sleeve ends 22 cm from the elbow, and the hand, bent away, reaches 12 cm beyond: its centre is not 10 cm behind that, which
// is in the sleeve, but a palm's 5 cm beyond the sleeve's end.
TEST(HandFinder, ABentHandBeginsAtTheSleeve) {
  Grid grid(geometry());
  Silhouette silhouette(grid);
  for (int y = 37; y < 45; ++y) fill_row(grid, y, 52, 64, 1.0F, silhouette.skin);
  std::vector<int> cells;
  for (int i = 0; i < grid.size(); ++i)
    if (silhouette.skin[static_cast<std::size_t>(i)]) cells.push_back(i);
  const Params params;
  const auto seen =
      HandFinder(grid).find(grid, silhouette, cells, grid.camera.unproject({30, 40.5}, 1), 0.25, 0.1, nullptr, params);
  ASSERT_TRUE(seen);
  EXPECT_NEAR(seen->tip_m, 0.335, 0.015);
  expect_near(seen->p, behind(grid.camera.unproject({52 + 5, 40.5}, 1), params.hand_depth_m), 0.01);
}

// In the picture's plane: turns out of it move points by less than a pixel, and are left to the prediction.
TEST(FitTorso, RecoversAKnownMotionDespiteOutliers) {
  const Pinhole camera{600, 320, 240, 0.1};
  const Rigid3 predicted{Mat3{}, {0.1, 0, 2}}, moved{rotation_of({0, 0, 0.08}), {0.13, -0.02, 1.95}};
  std::vector<TorsoPoint> points;
  for (int i = 0; i < 40; ++i) {
    const Vec3 local{0.03 * (i % 8) - 0.1, 0.05 * (i / 8), 0.02 * (i % 3)}, p = moved * local;
    points.push_back({local, camera.project(p), camera.disparity_px(p.z)});
    if (i % 7 == 3) points.back().at_px.x += 40;  // found on the wrong fold
  }
  const TorsoFit fit = fit_torso(camera, points, predicted);
  EXPECT_EQ(fit.inliers, 34);
  expect_near(fit.rig_from_torso.t_m, moved.t_m, 0.004);
  EXPECT_LT(norm(axis_of(fit.rig_from_torso.rotation * transposed(moved.rotation))), 0.01);
}

TEST(FitTorso, WithoutPointsThePredictionStays) {
  const Rigid3 predicted{rotation_of({0, 0.2, 0}), {0.1, 0, 2}};
  const TorsoFit fit = fit_torso({600, 320, 240, 0.1}, {}, predicted);
  EXPECT_EQ(fit.inliers, 0);
  expect_near(fit.rig_from_torso.t_m, predicted.t_m, 1e-12);
}

// A smooth texture, shifted by a known part of a pixel.
void paint(GrayLevels& gray, double shift_x, double shift_y) {
  Frame frame;
  frame.left = Image<std::uint8_t>({gray.full.width, gray.full.height});
  for (int y = 0; y < gray.full.height; ++y)
    for (int x = 0; x < gray.full.width; ++x) {
      const double u = x - shift_x, v = y - shift_y;
      const double value = std::sin(0.35 * u + 0.07 * v) + std::sin(0.31 * v - 0.11 * u) + std::sin(0.17 * u + 0.23 * v);
      frame.left.at(y, x) = static_cast<std::uint8_t>(std::lround(128 + 30 * value));
    }
  gray.build(frame);
}

TEST(Patches, FoundAgainToAFractionOfAPixel) {
  const Rectified r = geometry_of({160, 120}, 150);
  GrayLevels gray(r);
  paint(gray, 0, 0);
  const auto patch = cut_patch(gray, {70, 50});
  ASSERT_TRUE(patch);
  EXPECT_FALSE(cut_patch(gray, {3, 50}));  // over the border
  paint(gray, 5.25, -3.5);
  const auto match = find_patch(gray, *patch, {70, 50}, 1, 7);
  ASSERT_TRUE(match);
  EXPECT_NEAR(match->at_px.x, 75.25, 0.15);
  EXPECT_NEAR(match->at_px.y, 46.5, 0.15);
  EXPECT_GT(match->score, 0.95);
}

TEST(BodyMap, HoldsWhatWasSeenOftenEnough) {
  Grid grid(geometry());
  std::vector<std::uint8_t> mask(static_cast<std::size_t>(grid.size()));
  fill_row(grid, 40, 51, 55, 1.0F, mask);  // 4 cells in the voxel right of the origin
  const Rigid3 torso_from_rig{Mat3{}, {0, 0, -1}};
  BodyMap map;
  const Vec3 inside{0.02, 0.01, 0.01}, beside{-0.02, 0.01, 0.01};
  for (int i = 0; i < 5; ++i) map.learn(grid, mask, torso_from_rig, BodyMap::kGlimpse);
  EXPECT_FALSE(map.holds(inside));
  map.learn(grid, mask, torso_from_rig, BodyMap::kGlimpse);
  EXPECT_TRUE(map.holds(inside));
  EXPECT_FALSE(map.holds(beside));
  EXPECT_TRUE(map.holds_nearby(beside));
}

TEST(Background, FrontIsNearerAndOfAnotherColor) {
  Grid grid(geometry());
  std::fill(grid.inside.begin(), grid.inside.end(), std::uint8_t{1});
  std::fill(grid.z_m.begin(), grid.z_m.end(), 3.0F);
  std::fill(grid.color.begin(), grid.color.end(), Rgb{100, 100, 100});
  Background background(grid);
  background.start(grid, std::vector<std::uint8_t>(static_cast<std::size_t>(grid.size())));
  for (int y = 20; y < 40; ++y)
    for (int x = 20; x < 60; ++x) {
      const auto i = static_cast<std::size_t>(grid.at(x, y));
      grid.z_m[i] = 1.5F;
      if (x < 40) grid.color[i] = {180, 120, 90};  // the other half: stereo's error beside it, on the same wall
    }
  for (Rgb& c : grid.color) c = {0.5F * c.r, 0.5F * c.g, 0.5F * c.b};  // and the light is dimmed
  background.observe(grid);
  EXPECT_TRUE(background.front(grid, grid.at(30, 30)));
  EXPECT_FALSE(background.front(grid, grid.at(50, 30)));
  EXPECT_FALSE(background.front(grid, grid.at(80, 30)));
}

}  // namespace
}  // namespace duo::arm
