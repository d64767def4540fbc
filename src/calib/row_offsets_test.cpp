#include "calib/row_offsets.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "calib/lens_left_over.h"
#include "duoptic/engine.h"

namespace duo {
namespace {

constexpr Size kSize{640, 480};

/// Points all over the picture, or in a part of it, whose rows differ by `px`; each `wrong`-th lies anywhere.
template <class F>
SceneMatches scene_of(int points, F px, int wrong = 3, Size part = kSize) {
  std::mt19937 rng(4);
  const auto within = [&](int most) { return static_cast<double>(rng() % static_cast<unsigned>(16 * most)) / 16; };
  std::normal_distribution<double> noise(0, 0.1);
  SceneMatches out{kSize, 1, false, {}};
  for (int i = 0; i < points; ++i) {
    const Vec2 left = {within(part.width), within(part.height)}, right = {left.x - 20, left.y};
    const double y = wrong > 0 && i % wrong == 0 ? within(kSize.height) : left.y + px(right.x, right.y) + noise(rng);
    out.matches.push_back({left, {right.x, y}});
  }
  return out;
}

// The right picture was undistorted as another lens: 6 px lower at the corners, nothing in the middle.
TEST(RowOffsets, FindsWhatIsLeftOfALens) {
  const auto left_over = [](double x, double y) {
    const double u = (x - 319.5) / 319.5, v = (y - 239.5) / 319.5;
    return 5 * v * (u * u + v * v);
  };
  const RowOffsets rows = fit_row_offsets(scene_of(600, left_over));
  EXPECT_TRUE(rows.matter());
  EXPECT_LT(rows.after_px, 0.1);
  for (int y = 40; y < kSize.height; y += 80)
    for (int x = 40; x < kSize.width - 40; x += 80) EXPECT_NEAR(rows.at(x, y), left_over(x, y), 0.15) << x << ", " << y;
}

// The right picture was undistorted with a lens of r^4 and zoomed: rows tell, columns follow. A third of the matches is wrong,
// the scene has any depth.
TEST(RowOffsets, PutsColumnsOfAWrongLensRight) {
  const auto put_right = [](Vec2 px) {
    const double x = (px.x - 319.5) / 320, y = (px.y - 239.5) / 320, a = x - 0.03, b = y + 0.04, r2 = a * a + b * b;
    return Vec2{320 * 1.005 * (x - a * 0.08 * r2 * r2) + 319.5, 320 * 1.005 * (y - b * 0.08 * r2 * r2) + 239.5};
  };
  std::mt19937 rng(4);
  std::normal_distribution<double> noise(0, 0.1);
  const auto within = [&](int most) { return static_cast<double>(rng() % static_cast<unsigned>(16 * most)) / 16; };
  SceneMatches scene{kSize, 1, false, {}};
  for (int i = 0; i < 600; ++i) {
    const Vec2 right = {within(640), within(480)}, there = put_right(right);
    scene.matches.push_back({{there.x + within(60), i % 3 == 0 ? within(480) : there.y + noise(rng)}, right});
  }
  const RowOffsets rows = fit_row_offsets(scene);
  ASSERT_TRUE(rows.matter());
  ASSERT_TRUE(rows.lens);
  EXPECT_GT(rows.lens->columns_px, 3);
  LensPlaces places(rows);
  for (int y = 60; y < 440; y += 40)
    for (int x = 80; x < 580; x += 40) {
      const Vec2 there = put_right(places.at(x, y));
      EXPECT_NEAR(there.x, x, 0.5) << x << ", " << y;
      EXPECT_NEAR(there.y, y, 0.2) << x << ", " << y;
    }
}

TEST(RowOffsets, NoColumnsWhereRowsDoNotTell) {
  EXPECT_FALSE(fit_row_offsets(scene_of(600, [](double, double) { return 3.0; })).lens) << "a nudge";
  EXPECT_FALSE(fit_row_offsets(scene_of(90, [](double, double y) { return 0.03 * (y - 240); })).lens) << "few points";
}

TEST(RowOffsets, FindsABentFieldAmongWrongMatches) {
  const auto bent = [](double x, double y) { return 1.5 - 0.002 * x + 0.004 * y + 4e-6 * x * x - 6e-6 * y * x; };
  const RowOffsets rows = fit_row_offsets(scene_of(600, bent));
  EXPECT_TRUE(rows.matter());
  EXPECT_GT(rows.points, 350);
  EXPECT_LT(rows.points, 420) << "wrong ones do not count";
  EXPECT_GT(rows.before_px, 1);
  EXPECT_LT(rows.after_px, 0.1);
  for (int y = 40; y < kSize.height; y += 80)
    for (int x = 40; x < kSize.width - 40; x += 80) EXPECT_NEAR(rows.at(x, y), bent(x, y), 0.1) << x << ", " << y;
}

TEST(RowOffsets, KeepsToWhatThePointsShow) {
  // In a corner only, where rows tilt: elsewhere nothing is known, and the tilt does not go on for ever.
  const RowOffsets rows = fit_row_offsets(scene_of(80, [](double x, double) { return 0.5 + 0.004 * x; }, 0, {160, 120}));
  EXPECT_TRUE(rows.matter());
  EXPECT_NEAR(rows.at(80, 60), 0.8, 0.1);
  EXPECT_LT(rows.at(639, 479), 1.3);
  EXPECT_GT(rows.at(639, 479), 0.3);
}

TEST(RowOffsets, LeavesAloneWhatIsRightOrUnknown) {
  EXPECT_FALSE(fit_row_offsets(scene_of(600, [](double, double) { return 0.05; })).matter()) << "less than it costs";
  EXPECT_FALSE(fit_row_offsets(scene_of(
                                   20, [](double, double) { return 1.0; }, 0))
                   .matter())
      << "too few points";
  EXPECT_FALSE(fit_row_offsets(scene_of(
                                   600, [](double, double) { return 1.0; }, 1))
                   .matter())
      << "nothing agrees";
  const RowOffsets none = fit_row_offsets({kSize, 1, false, {}});
  EXPECT_EQ(none.points, 0);
  EXPECT_EQ(none.at(10, 10), 0);
}

/// Smooth random texture, in the right picture 12 px to the left and `down_px` rows lower.
Pair textured(Size size, double down_px) {
  std::mt19937 rng(9);
  constexpr int kCell = 6;
  Image<std::uint8_t> coarse({size.width / kCell + 8, size.height / kCell + 8});
  for (int y = 0; y < coarse.height(); ++y)
    for (int x = 0; x < coarse.width(); ++x) coarse.at(y, x) = static_cast<std::uint8_t>(rng() % 256);
  const auto at = [&](double x, double y) {
    const int i = static_cast<int>(x / kCell), j = static_cast<int>(y / kCell);
    const double f = x / kCell - i, g = y / kCell - j;
    const double top = coarse.at(j, i) * (1 - f) + coarse.at(j, i + 1) * f;
    const double bottom = coarse.at(j + 1, i) * (1 - f) + coarse.at(j + 1, i + 1) * f;
    const auto v = static_cast<std::uint8_t>(std::lround(top * (1 - g) + bottom * g));
    return Rgb8{v, v, v};
  };
  Pair pair;
  pair.left.pixels = Image<Rgb8>(size);
  pair.right.pixels = Image<Rgb8>(size);
  for (int y = 0; y < size.height; ++y)
    for (int x = 0; x < size.width; ++x) {
      pair.left.pixels.at(y, x) = at(x, y + 4);
      pair.right.pixels.at(y, x) = at(x + 12, y + 4 - down_px);
    }
  return pair;
}

/// Share of the pixels with a disparity within half a pixel of 12 px.
double right_share(Engine& engine, const Pair& pair) {
  engine.submit(pair);
  const std::shared_ptr<const Frame> frame = engine.collect();
  const Image<std::uint16_t>& d_q4 = frame->disparity.d_q4;
  int right = 0;
  for (int y = 0; y < d_q4.height(); ++y)
    for (int x = 0; x < d_q4.width(); ++x) right += std::abs(d_q4.at(y, x) - 12 * 16) <= 8;
  return static_cast<double>(right) / (d_q4.width() * d_q4.height());
}

TEST(RowOffsets, MatchingFindsRowsThatArePutRight) {
  const Pair pair = textured({320, 240}, 2.25);
  const RowOffsets rows = find_row_offsets(pair, 2);
  ASSERT_TRUE(rows.matter());
  EXPECT_NEAR(rows.at(160, 120), 2.25, 0.1);
  const auto engine = *make_engine("simd", 2);
  duo::Setup setup;
  setup.size = {320, 240};
  setup.max_disparity = 32;
  ASSERT_TRUE(engine->prepare(setup));
  EXPECT_LT(right_share(*engine, pair), 0.8);
  setup.rows = rows;
  ASSERT_TRUE(engine->prepare(setup));
  EXPECT_GT(right_share(*engine, pair), 0.9);
}

// The left picture stays where it is, to its last row and column; only its gray rows are blurred a little.
TEST(RowOffsets, TheLeftPictureStays) {
  Pair pair = textured({64, 48}, 0);
  duo::Setup setup;
  setup.size = {64, 48};
  setup.max_disparity = 16;
  setup.rows = RowOffsets{setup.size, {0.5}, -1, 1, 100, 0.5, 0.1};
  setup.wants.color = true;
  for (const char* name : {"ref", "simd"}) {
    const auto engine = *make_engine(name, 1);
    ASSERT_TRUE(engine->prepare(setup));
    engine->submit(pair);
    const std::shared_ptr<const Frame> frame = engine->collect();
    for (int y = 0; y < 48; ++y)
      for (int x = 0; x < 64; ++x) {
        const Rgb8 &want = pair.left.pixels.at(y, x), &got = frame->color.at(y, x);
        EXPECT_TRUE(want.r == got.r && want.g == got.g && want.b == got.b) << name << " " << x << "," << y;
        EXPECT_EQ(frame->left_inside.at(y, x), 255);
        EXPECT_EQ(frame->right_inside.at(y, x), 255) << "half a row beyond the picture is nothing to lose";
        EXPECT_NEAR(frame->left.at(y, x), want.g, 10) << name << " " << x << "," << y;
      }
  }
}

TEST(RowOffsets, EnginesRefuseThoseOfOtherPictures) {
  const auto engine = *make_engine("simd", 1);
  duo::Setup setup;
  setup.size = {64, 48};
  setup.rows.emplace().size = {64, 40};
  const auto other = engine->prepare(setup);
  ASSERT_FALSE(other);
  EXPECT_NE(other.error().what.find("64x40"), std::string::npos) << other.error().what;
  setup.rows->size = setup.size;
  EXPECT_TRUE(engine->prepare(setup));
}

}  // namespace
}  // namespace duo
