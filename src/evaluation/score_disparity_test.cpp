// The scorer against counts worked out by hand.
#include "duoptic/evaluation.h"

#include <gtest/gtest.h>

namespace duo {
namespace {

Image<float> row(std::initializer_list<float> values) {
  Image<float> out({static_cast<int>(values.size()), 1});
  int x = 0;
  for (float v : values) out.at(0, x++) = v;
  return out;
}

TEST(DisparityScore, HolesTakeTheSmallerNeighbour) {
  Image<float> d = row({-1, 5, -1, -1, 3, -1});
  fill_rows(d);
  const float want[] = {5, 5, 3, 3, 3, 3};
  for (int x = 0; x < 6; ++x) EXPECT_EQ(d.at(0, x), want[x]) << x;
}

TEST(DisparityScore, EmptyRowsTakeTheNearestRow) {
  Image<float> d({1, 4});
  d.at(0, 0) = d.at(1, 0) = d.at(2, 0) = -1;
  d.at(3, 0) = 7;
  fill_rows(d);
  for (int y = 0; y < 4; ++y) EXPECT_EQ(d.at(y, 0), 7) << y;
}

TEST(DisparityScore, CountsBadPixelsInEachRegion) {
  StereoScene scene;
  scene.truth_px = row({4, 4, 4, 4});
  const auto mask = [](std::initializer_list<int> values) {
    Image<std::uint8_t> out({4, 1});
    int x = 0;
    for (int v : values) out.at(0, x++) = v != 0 ? 255 : 0;
    return out;
  };
  scene.regions = {mask({1, 1, 1, 1}), mask({1, 1, 1, 0}), mask({1, 0, 0, 0})};
  const DisparityScore s = score_disparity(row({4.75f, 5, -1, 7}), scene);
  // Errors 0.75, 1 (not more than 1), a hole that fills with 5, 3.
  EXPECT_NEAR(s.bad_holes[0][1], 100, 1e-9);
  EXPECT_NEAR(s.bad_holes[1][1], 50, 1e-9);
  EXPECT_NEAR(s.bad_filled[1][1], 25, 1e-9);
  EXPECT_NEAR(s.bad_holes[1][0], 100.0 / 3, 1e-9);
  EXPECT_NEAR(s.bad_filled[1][0], 0, 1e-9);
  EXPECT_NEAR(s.bad_holes[0][2], 100, 1e-9);
  EXPECT_NEAR(s.coverage_percent, 75, 1e-9);
  EXPECT_NEAR(s.average_error_px, (0.75 + 1 + 1 + 3) / 4, 1e-6);
}

TEST(SceneRegions, OcclusionAndJump) {
  // A near surface (d 4) right of a far one (d 1): its left edge hides the 3 far pixels left of it in the right view.
  Image<float> truth({20, 1});
  for (int x = 0; x < 20; ++x) truth.at(0, x) = x < 10 ? 1.0f : 4.0f;
  const SceneRegions r = regions_of_truth(truth, 0);
  const char* nonocc = "01111110001111111111";
  for (int x = 0; x < 20; ++x) EXPECT_EQ(r.nonocc.at(0, x) != 0, nonocc[x] == '1') << x;
  EXPECT_NE(r.disc.at(0, 13), 0);  // four pixels from the jump at 9 | 10
  EXPECT_EQ(r.disc.at(0, 15), 0);
  EXPECT_EQ(regions_of_truth(truth, 5).all.at(0, 7), 0);  // the row lies in the border
}

}  // namespace
}  // namespace duo
