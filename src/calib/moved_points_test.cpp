// What moved between two photos, of points that are given.
#include "calib/moved_points.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <random>

namespace duo {
namespace {

constexpr Size kPhotoSize = {320, 240};

Image<Rgb8> noise(std::uint32_t seed) {
  std::mt19937 random(seed);
  Image<Rgb8> out(kPhotoSize);
  for (int y = 0; y < out.height(); ++y)
    for (int x = 0; x < out.width(); ++x) {
      const auto level = static_cast<std::uint8_t>(random() % 256);
      out.at(y, x) = {level, level, level};
    }
  return out;
}

/// Of photos in which nothing looks alike: ten neighbours of row 40 that are said to lie in that row of the right one, among a
/// hundred in their rows.
std::string told_of(double right_row) {
  std::vector<SceneMatch> agreeing;
  for (int i = 0; i < 100; ++i) {
    const Vec2 at = {30 + 25.0 * (i % 10), 20 + 20.0 * (i / 10)};
    agreeing.push_back({at, {at.x - 20, at.y}});
  }
  SceneMatches scene{kPhotoSize, 1, false, agreeing};
  for (int i = 0; i < 10; ++i) scene.matches.push_back({{150 + 4.0 * i, 40}, {130 + 4.0 * i, right_row}});
  Pair pair;
  pair.left.pixels = noise(1), pair.right.pixels = noise(2);
  return why_moved(std::nullopt, scene, agreeing, pair);
}

/// Near a border nothing can be compared with what lies in the row.
TEST(MovedPoints, AreToldNearABorderToo) {
  EXPECT_NE(told_of(4).find("36 px off their rows"), std::string::npos) << told_of(4);
  EXPECT_EQ(told_of(41), "");
}

}  // namespace
}  // namespace duo
