// A wall that shows half a gray level of texture: too little for points, enough for patches of the mean of some pairs.
#include "calib/scene_patches.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <random>

#include "calib/rig_fitting.h"
#include "calib/scene_pose.h"
#include "tests/turned_rig.h"

namespace duo {
namespace {

using test::right_turned;
using test::turn;

constexpr Size kWallSize = {480, 360};
constexpr int kWallDisparity_px = 24;

Rig rig_before_wall() {
  Rig rig;
  rig.left = rig.right = {.size = kWallSize, .fx_px = 400, .fy_px = 400, .cx_px = 239.5, .cy_px = 179.5};
  rig.right_from_left.t_m = {-0.12, 0, 0};
  return rig;
}

/// Levels in 3 x 3 pixels; one standard deviation of the wall's is about 0.6, of the noise 2.
class Wall {
 public:
  explicit Wall(std::uint32_t seed) : random_(seed), texture_({kWallSize.width + kWallDisparity_px, kWallSize.height}) {
    std::vector<float> row(static_cast<std::size_t>(texture_.width()));
    for (int y = 0; y < texture_.height(); ++y) {
      if (y % 3 == 0)
        for (std::size_t x = 0; x < row.size(); ++x) row[x] = x % 3 == 0 ? uniform(1) : row[x - 1];
      std::copy(row.begin(), row.end(), texture_.row(y));
    }
  }
  std::shared_ptr<const Pair> pair() {
    auto out = std::make_shared<Pair>();
    out->left.pixels = seen_from(0);
    out->right.pixels = seen_from(kWallDisparity_px);
    return out;
  }

 private:
  float uniform(float most) { return most * (static_cast<float>(random_() >> 8) / (1 << 23) - 1); }
  Image<Rgb8> seen_from(int x0) {
    Image<Rgb8> out(kWallSize);
    for (int y = 0; y < out.height(); ++y)
      for (int x = 0; x < out.width(); ++x) {
        const auto level = static_cast<std::uint8_t>(std::lround(128 + texture_.at(y, x + x0) + uniform(3.5f)));
        out.at(y, x) = {level, level, level};
      }
    return out;
  }

  std::mt19937 random_;
  Image<float> texture_;
};

TEST(ScenePatches, OfAMeanTellTheRowsOfABareWall) {
  const Rig rig = rig_before_wall();
  Wall wall(1);
  PairSum sum(kWallSize);
  for (int i = 0; i < 12; ++i) sum.add(*wall.pair());
  EXPECT_EQ(sum.pairs(), 12);
  const SceneMatches scene = match_patches(rig, sum);
  EXPECT_GT(scene.matches.size(), 300u);
  EXPECT_GT(covered_share(scene.matches, kWallSize), 0.8);
  int right = 0;
  for (const SceneMatch& m : scene.matches)
    right += std::abs(m.left_px.x - m.right_px.x - kWallDisparity_px) < 1 && std::abs(m.left_px.y - m.right_px.y) < 1;
  EXPECT_GT(right, 0.95 * static_cast<double>(scene.matches.size()));
  // One pair alone shows noise.
  PairSum one(kWallSize);
  one.add(*wall.pair());
  EXPECT_LT(match_patches(rig, one).matches.size(), scene.matches.size() / 2);

  const auto told = [&](const Rig& of) {
    RigFitting fitting(of, kWallSize, 1);
    const auto pair = wall.pair();
    const auto fit = fitting.by_first(pair);
    return fit ? fit->what : fitting.by_all({}, sum).what;
  };
  EXPECT_EQ(told(rig), "");
  for (const double pan : {0.6, -0.6})
    EXPECT_NE(told(right_turned(rig, turn(0, pan, 0))).find("does not fit"), std::string::npos) << pan;
}

}  // namespace
}  // namespace duo
