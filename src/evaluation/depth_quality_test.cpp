// Depth quality on planes whose noise, holes and place are known.
#include "duoptic/depth_quality.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

namespace duo {
namespace {

constexpr Size kSize{320, 240};

Rectified camera() {
  Rectified out;
  static_cast<Pinhole&>(out) = {500, 160, 120, 0.1};
  out.size = kSize;
  return out;
}

struct Wall {
  double z_m = 1, turn_deg = 0;  // on the axis; about the vertical
  double noise_px = 0, holes = 0;
};

/// The disparities of a wall, rounded to sixteenths as the engine's are.
Frame seen(const Wall& wall, std::mt19937& random) {
  const Rectified c = camera();
  std::normal_distribution<double> noise(0, std::max(wall.noise_px, 1e-12));
  std::uniform_real_distribution<double> share(0, 1);
  Frame frame;
  frame.disparity.d_q4 = Image<std::uint16_t>(kSize);
  const double slope = std::tan(wall.turn_deg * std::numbers::pi / 180);
  for (int y = 0; y < kSize.height; ++y)
    for (int x = 0; x < kSize.width; ++x) {
      const double z_m = wall.z_m / (1 - slope * (x - c.cx_px) / c.focal_px);
      const double d_px = c.disparity_px(z_m) + (wall.noise_px > 0 ? noise(random) : 0);
      frame.disparity.d_q4.at(y, x) =
          share(random) < wall.holes ? Disparity::kNone : static_cast<std::uint16_t>(std::lround(16 * d_px));
    }
  return frame;
}

DepthQuality measured(const Wall& wall, int frames, std::optional<double> true_distance_m = std::nullopt) {
  std::mt19937 random(5);
  DepthQualityMeter meter(camera(), {40, 30, 240, 180}, true_distance_m);
  for (int i = 0; i < frames; ++i) EXPECT_TRUE(meter.add(seen(wall, random)));
  return meter.quality();
}

/// Standard deviation of the rounding to sixteenths, which adds to the noise.
double with_rounding(double noise_px) { return std::hypot(noise_px, 1 / 16.0 / std::sqrt(12.0)); }

TEST(DepthQuality, MeetsTheTruthOfNoisyWalls) {
  const Rectified c = camera();
  for (const double z_m : {1.0, 2.0, 3.0})
    for (const double noise_px : {0.1, 0.3}) {
      SCOPED_TRACE(std::to_string(z_m) + " m, " + std::to_string(noise_px) + " px");
      const DepthQuality q = measured({.z_m = z_m, .noise_px = noise_px, .holes = 0.2}, 20, 0.98 * z_m);
      const double sigma_px = with_rounding(noise_px), sigma_mm = 1000 * z_m * sigma_px / c.disparity_px(z_m);
      EXPECT_EQ(q.frames, 20);
      EXPECT_NEAR(q.fill_rate_percent, 80, 0.05 * 80);
      EXPECT_NEAR(q.distance_m, z_m, 0.002 * z_m);
      EXPECT_NEAR(q.subpixel_rms_px, sigma_px, 0.05 * sigma_px);
      EXPECT_NEAR(q.plane_fit_rms_mm, sigma_mm, 0.05 * sigma_mm);
      EXPECT_NEAR(q.temporal_noise_mm, sigma_mm, 0.05 * sigma_mm);
      EXPECT_NEAR(q.temporal_noise_percent, 100 * sigma_px / c.disparity_px(z_m), 5 * sigma_px / c.disparity_px(z_m));
      EXPECT_NEAR(*q.z_error_mm, 20 * z_m, 0.05 * 20 * z_m);
      EXPECT_NEAR(*q.z_accuracy_percent, 100 * (1 / 0.98 - 1), 0.05 * 100 * (1 / 0.98 - 1));
    }
}

// A turned wall is as flat: its distance is that at a right angle, and the foot of a point on it lies nearer by the cosine,
// twice.
TEST(DepthQuality, ATurnedWallIsAsFlat) {
  const DepthQuality q = measured({.z_m = 1.5, .turn_deg = 20, .noise_px = 0.2}, 3);
  const double turn = 20 * std::numbers::pi / 180;
  EXPECT_NEAR(q.angle_deg, 20, 0.3);
  EXPECT_NEAR(q.distance_m, 1.5 * std::cos(turn), 0.005);
  const double foot_px = with_rounding(0.2) * std::cos(turn) * std::cos(turn);
  EXPECT_NEAR(q.subpixel_rms_px, foot_px, 0.05 * foot_px);
  EXPECT_FALSE(q.z_error_mm);
}

TEST(DepthQuality, ByHand) {
  // Every other column is one sixteenth of a pixel nearer: both are half of that off the plane between them.
  Frame frame;
  frame.disparity.d_q4 = Image<std::uint16_t>(kSize);
  for (int y = 0; y < kSize.height; ++y)
    for (int x = 0; x < kSize.width; ++x) frame.disparity.d_q4.at(y, x) = static_cast<std::uint16_t>(400 + x % 2);
  DepthQualityMeter meter(camera(), {100, 80, 100, 100});
  ASSERT_TRUE(meter.add(frame));
  const DepthQuality q = meter.quality();
  EXPECT_EQ(q.fill_rate_percent, 100);
  EXPECT_NEAR(q.subpixel_rms_px, 1 / 32.0, 1e-4);
  EXPECT_NEAR(q.plane_fit_rms_mm, 1000 * (2 - 50 / (401 / 16.0)) / 2, 1e-2);  // 50 m px / 25 px = 2 m
  EXPECT_NEAR(q.distance_m, 2 - 0.0025, 1e-4);
  EXPECT_EQ(q.temporal_noise_mm, 0);
}

TEST(DepthQuality, RefusesWhereThereIsNoWall) {
  std::mt19937 random(1);
  DepthQualityMeter empty(camera(), {0, 0, 100, 100}), line(camera(), {0, 50, 320, 1});
  const auto nothing = empty.add(seen({.holes = 1}, random)), thin = line.add(seen({}, random));
  ASSERT_FALSE(nothing);
  EXPECT_NE(nothing.error().what.find("0 of its 10000 pixels have a depth"), std::string::npos) << nothing.error().what;
  ASSERT_FALSE(thin);
  EXPECT_NE(thin.error().what.find("on a line"), std::string::npos) << thin.error().what;
}

// Of a region that is chosen: figures from the first frame on, each frame once; none of a region that is taken away.
TEST(RegionQuality, MeasuresTheRegionThatIsChosen) {
  std::mt19937 random(2);
  RegionQuality quality;
  Frame frame = seen({.z_m = 1.5, .noise_px = 0.1}, random);
  quality.add(frame);
  EXPECT_TRUE(quality.lines().empty());
  quality.choose(camera(), {300, 200, 100, 100});
  EXPECT_EQ(quality.region(), (Window{300, 200, 20, 40}));
  quality.add(frame);
  ASSERT_EQ(quality.lines().size(), 3U);
  EXPECT_EQ(quality.lines()[1], "fill rate 100.0 %");
  quality.set_distance(1.4);
  for (std::uint64_t i = 1; i <= 6; ++i) {
    frame.sequence = i;
    quality.add(frame);
    quality.add(frame);
  }
  ASSERT_EQ(quality.lines().size(), 5U);
  EXPECT_NE(quality.lines()[3].find("of 6 frames"), std::string::npos) << quality.lines()[3];
  EXPECT_NEAR(std::stod(quality.lines()[4].substr(8)), 100, 10) << quality.lines()[4];  // mm
  quality.choose(camera(), {});
  EXPECT_TRUE(quality.lines().empty());
}

}  // namespace
}  // namespace duo
