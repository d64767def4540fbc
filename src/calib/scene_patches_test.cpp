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

constexpr int kWallDisparity_px = 18;

Rig rig_before_wall(Size size) {
  Rig rig;
  rig.left =
      rig.right = {.size = size, .fx_px = 300, .fy_px = 300, .cx_px = (size.width - 1) / 2.0, .cy_px = (size.height - 1) / 2.0};
  rig.right_from_left.t_m = {-0.12, 0, 0};
  return rig;
}

/// Levels in 3 x 3 pixels; one standard deviation of the wall's is about 0.6, of the noise 2.
class Wall {
 public:
  explicit Wall(Size size) : size_(size), texture_({size.width + kWallDisparity_px, size.height}) {
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
    Image<Rgb8> out(size_);
    for (int y = 0; y < out.height(); ++y)
      for (int x = 0; x < out.width(); ++x) {
        const auto level = static_cast<std::uint8_t>(std::lround(128 + texture_.at(y, x + x0) + uniform(3.5f)));
        out.at(y, x) = {level, level, level};
      }
    return out;
  }

  const Size size_;
  std::mt19937 random_{1};
  Image<float> texture_;
};

/// Some pairs in front of it, and their sum.
struct BeforeWall {
  explicit BeforeWall(Size size) : rig(rig_before_wall(size)), wall(size), sum(size) {
    for (int i = 0; i < 12; ++i) sum.add(*wall.pair());
  }
  RigFit fit_of(const Rig& of) {
    RigFitting fitting(of, of.left.size, 1);
    const auto fit = fitting.by_first(wall.pair());
    return fit ? *fit : fitting.by_all({}, &sum);
  }
  Rig rig;
  Wall wall;
  PairSum sum;
};

TEST(ScenePatches, OfAMeanLieInTheirRows) {
  BeforeWall before({176, 132});
  const SceneMatches scene = match_patches(before.rig, before.sum);
  EXPECT_EQ(before.sum.pairs(), 12);
  EXPECT_EQ(scene.pairs, 12);
  EXPECT_GT(scene.matches.size(), 70u);
  EXPECT_GT(covered_share(scene.matches, scene.size), 0.6);  // all but what the borders take
  int right = 0;
  for (const SceneMatch& m : scene.matches)
    right += std::abs(m.left_px.x - m.right_px.x - kWallDisparity_px) < 1 && std::abs(m.left_px.y - m.right_px.y) < 1;
  EXPECT_GT(right, 0.95 * static_cast<double>(scene.matches.size()));
  // One pair alone shows noise.
  PairSum one(scene.size);
  one.add(*before.wall.pair());
  EXPECT_LT(match_patches(before.rig, one).matches.size(), scene.matches.size() / 2);
  EXPECT_EQ(before.fit_of(before.rig).what, "");
}

TEST(ScenePatches, OfAMeanTellAPanBeforeABareWall) {
  BeforeWall before({352, 264});
  EXPECT_EQ(before.fit_of(before.rig).what, "");
  for (const double pan : {0.6, -0.6}) {
    const RigFit fit = before.fit_of(right_turned(before.rig, turn(0, pan, 0)));
    EXPECT_NE(fit.what.find("does not fit"), std::string::npos) << pan;
    ASSERT_TRUE(fit.scene);
    EXPECT_EQ(fit.scene->pairs, 12);
    EXPECT_GT(fit.scene->points, 300);
    EXPECT_GT(fit.scene->covered, 0.8);
  }
}

}  // namespace
}  // namespace duo
