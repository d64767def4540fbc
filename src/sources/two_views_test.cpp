// Two views of one drawn scene are told from two halves of one view, whose smooth texture looks alike in many places by chance.
#include "sources/two_views.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <utility>
#include <vector>

namespace duo {
namespace {

/// Smooth noise: random levels every `cell_px`, and every third as many larger ones.
class Texture {
 public:
  Texture(unsigned seed, int cell_px) : cell_px_(cell_px), fine_(kSide * kSide), coarse_(kSide * kSide) {
    std::mt19937 random(seed);
    for (auto* levels : {&fine_, &coarse_})
      for (double& level : *levels) level = 20 + static_cast<double>(random() % 200);
  }
  double at(double x, double y) const { return 0.6 * level(fine_, x, y, cell_px_) + 0.4 * level(coarse_, x, y, 3 * cell_px_); }

 private:
  static constexpr int kSide = 400;
  static double level(const std::vector<double>& of, double x, double y, int cell_px) {
    const double u = x / cell_px, v = y / cell_px, fu = u - std::floor(u), fv = v - std::floor(v);
    const auto get = [&](int dx, int dy) {
      return of[static_cast<std::size_t>((static_cast<int>(v) + dy) * kSide + static_cast<int>(u) + dx)];
    };
    return (1 - fv) * ((1 - fu) * get(0, 0) + fu * get(1, 0)) + fv * ((1 - fu) * get(0, 1) + fu * get(1, 1));
  }
  int cell_px_;
  std::vector<double> fine_, coarse_;
};

/// A wall of that texture, from column `begin` on, and a box before it that is `disparity_px` further left.
Image<Rgb8> view_of(const Texture& wall, const Texture& box, int begin, int disparity_px, double gain) {
  Image<Rgb8> out({320, 240});
  for (int y = 0; y < 240; ++y)
    for (int x = 0; x < 320; ++x) {
      const int in_box = x + disparity_px - 110;
      const double level = y >= 70 && y < 170 && in_box >= 0 && in_box < 100 ? box.at(in_box, y) : wall.at(begin + x, y);
      const auto v = static_cast<std::uint8_t>(std::lround(gain * level));
      out.at(y, x) = {v, v, v};
    }
  return out;
}

TEST(TwoViews, HalvesOfOneDrawnViewAreNotTwo) {
  for (const auto& [seed, cell_px] : {std::pair(0U, 8), {3U, 8}, {6U, 3}}) {
    const Texture wall(seed, cell_px), box(seed + 1, cell_px), other_box(seed + 2, cell_px);
    const Image<Rgb8> left = view_of(wall, box, 20, 0, 1), right = view_of(wall, box, 26, 16, 0.7),
                      beside = view_of(wall, other_box, 340, 0, 1);
    EXPECT_EQ(show_the_same(left.view(), right.view()), SameScene::kYes) << seed;
    EXPECT_EQ(show_the_same(left.view(), beside.view()), SameScene::kNo) << seed;
  }
}

TEST(TwoViews, WhatIsFlatTellsNothing) {
  const Image<Rgb8> flat({320, 240});
  EXPECT_EQ(show_the_same(flat.view(), flat.view()), SameScene::kUnknown);
}

}  // namespace
}  // namespace duo
