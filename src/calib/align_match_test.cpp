#include "calib/align_match.h"

#include <gtest/gtest.h>

#include <cmath>

namespace duo {
namespace {

/// A smooth texture without a period, known between the pixels.
double texture(double x, double y) {
  return 100 + 30 * std::sin(0.45 * x + 0.1 * y) + 25 * std::sin(0.31 * y - 0.07 * x + 1) + 20 * std::sin(0.23 * (x + y));
}

template <class At>
Image<float> picture(At at) {
  Image<float> out({96, 80});
  for (int y = 0; y < out.height(); ++y)
    for (int x = 0; x < out.width(); ++x) out.at(y, x) = static_cast<float>(at(x, y));
  return out;
}

std::optional<Vec2> aligned(const Image<float>& left, Vec2 left_px, const Image<float>& right, Vec2 right_px) {
  Image<SlopedPixel> sloped;
  put_slopes(right, sloped);
  return align_match(left, left_px, sloped, right_px, 8);
}

TEST(AlignMatch, SlopesByHand) {
  Image<float> steps({4, 3});
  for (int y = 0; y < 3; ++y)
    for (int x = 0; x < 4; ++x) steps.at(y, x) = static_cast<float>(x * x + 10 * y);
  Image<SlopedPixel> sloped;
  put_slopes(steps, sloped);
  EXPECT_EQ(sloped.at(1, 2).value, 14);
  EXPECT_EQ(sloped.at(1, 2).slope_x, 4);  // (9 - 1) / 2
  EXPECT_EQ(sloped.at(1, 2).slope_y, 10);
  EXPECT_EQ(sloped.at(1, 0).slope_x, 0);
  EXPECT_EQ(sloped.at(0, 2).slope_y, 0);
}

TEST(AlignMatch, FindsShiftStretchShearGainAndOffset) {
  const Image<float> left = picture(texture);
  // The left point (40, 38.5) lies at (43.3, 37.9) in the right picture.
  const Image<float> right = picture([](double x, double y) {
    const double dy = y - 37.9, dx = (x - 43.3 - 0.05 * dy) / 1.1;
    return 0.8 * texture(40 + dx, 38.5 + dy) + 17;
  });
  const auto there = aligned(left, {40, 38.5}, right, {42.5, 38.7});
  ASSERT_TRUE(there);
  EXPECT_NEAR(there->x, 43.3, 0.02);
  EXPECT_NEAR(there->y, 37.9, 0.02);
}

TEST(AlignMatch, KnowsWhenItCannot) {
  const Image<float> left = picture(texture);
  EXPECT_TRUE(aligned(left, {40, 40}, left, {40.4, 39.7}));
  EXPECT_FALSE(aligned(left, {7, 40}, left, {40, 40})) << "left patch over the border";
  EXPECT_FALSE(aligned(left, {40, 40}, left, {13, 40})) << "right patch, stretched, over the border";
  EXPECT_FALSE(aligned(left, {40, 40}, left, {40, 73})) << "right patch over the lower border";
  EXPECT_FALSE(aligned(left, {40, 40}, left, {-1e9, 40}));
  const Image<float> flat = picture([](double, double) { return 90; });
  EXPECT_FALSE(aligned(flat, {40, 40}, left, {40, 40})) << "no texture";
  const Image<float> columns = picture([](double x, double) { return 100 + 50 * std::sin(0.5 * x); });
  EXPECT_FALSE(aligned(columns, {40, 40}, columns, {40.3, 41})) << "the row is not known";
  const Image<float> rows = picture([](double, double y) { return 100 + 50 * std::sin(0.5 * y); });
  EXPECT_FALSE(aligned(rows, {40, 40}, rows, {40.3, 40.2})) << "the column is not known";
  const Image<float> other = picture([](double x, double y) { return texture(3 * y, 2 * x + 11); });
  EXPECT_FALSE(aligned(left, {40, 40}, other, {40, 40})) << "does not look the same";
}

}  // namespace
}  // namespace duo
