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

TEST(AlignMatch, FindsShiftStretchShearGainAndOffset) {
  const Image<float> left = picture(texture);
  // The left point (40, 38.5) lies at (43.3, 37.9) in the right picture.
  const Image<float> right = picture([](double x, double y) {
    const double dy = y - 37.9, dx = (x - 43.3 - 0.05 * dy) / 1.1;
    return 0.8 * texture(40 + dx, 38.5 + dy) + 17;
  });
  const auto there = align_match(left, {40, 38.5}, right, {42.5, 38.7}, 8);
  ASSERT_TRUE(there);
  EXPECT_NEAR(there->x, 43.3, 0.02);
  EXPECT_NEAR(there->y, 37.9, 0.02);
}

TEST(AlignMatch, KnowsWhenItCannot) {
  const Image<float> left = picture(texture);
  EXPECT_TRUE(align_match(left, {40, 40}, left, {40.4, 39.7}, 8));
  EXPECT_FALSE(align_match(left, {7, 40}, left, {40, 40}, 8)) << "left patch over the border";
  EXPECT_FALSE(align_match(left, {40, 40}, left, {13, 40}, 8)) << "right patch, stretched, over the border";
  EXPECT_FALSE(align_match(left, {40, 40}, left, {40, 73}, 8)) << "right patch over the lower border";
  EXPECT_FALSE(align_match(left, {40, 40}, left, {-1e9, 40}, 8));
  const Image<float> flat = picture([](double, double) { return 90; });
  EXPECT_FALSE(align_match(flat, {40, 40}, left, {40, 40}, 8)) << "no texture";
  const Image<float> columns = picture([](double x, double) { return 100 + 50 * std::sin(0.5 * x); });
  EXPECT_FALSE(align_match(columns, {40, 40}, columns, {40.3, 41}, 8)) << "the row is not known";
  const Image<float> rows = picture([](double, double y) { return 100 + 50 * std::sin(0.5 * y); });
  EXPECT_FALSE(align_match(rows, {40, 40}, rows, {40.3, 40.2}, 8)) << "the column is not known";
  const Image<float> other = picture([](double x, double y) { return texture(3 * y, 2 * x + 11); });
  EXPECT_FALSE(align_match(left, {40, 40}, other, {40, 40}, 8)) << "does not look the same";
}

}  // namespace
}  // namespace duo
