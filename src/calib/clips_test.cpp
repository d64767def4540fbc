// The rendered clips of the test data: their rig files and the true pixels of a person's joints.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>

#include "calib/rectification.h"
#include "tests/data.h"

namespace duo {
namespace {

namespace fs = std::filesystem;

class Clips : public testing::TestWithParam<const char*> {
 protected:
  void SetUp() override {
    folder_ = test::data_folder() / "sequences" / GetParam();
    if (!fs::exists(folder_)) GTEST_SKIP() << "skipped: no data";
  }
  fs::path folder_;
};

bool inside(const ResampleMap& map, Vec2 at) {
  const int x = int(std::lround(at.x)), y = int(std::lround(at.y));
  const auto [w, h] = map.corner.size();
  return x >= 0 && y >= 0 && x < w && y < h && map.corner.at(y, x) != ResampleMap::kOutside;
}

/// Far enough from the border that the nearest pixel of the canvas is covered too.
bool well_inside(Vec2 raw_px, Size size) {
  return raw_px.x >= 1 && raw_px.y >= 1 && raw_px.x <= size.width - 2 && raw_px.y <= size.height - 2;
}

// Where both true pixels are known, our rectification must put them on one row, at the true distance, and keep them.
TEST_P(Clips, JointsLieOnOneRow) {
  const auto rig = load_rig(folder_ / "calibration_truth.yml");
  ASSERT_TRUE(rig) << rig.error().what;
  const auto r = make_rectification(*rig, GetParam());
  ASSERT_TRUE(r) << r.error().what;
  const Rectified& geometry = r->geometry;
  const Lens left(rig->left), right(rig->right);
  std::ifstream file(folder_ / "truth.json");
  const auto truth = nlohmann::json::parse(file);
  EXPECT_NEAR(geometry.baseline_m, truth["meta"]["baseline_m"].get<double>(), 1e-5);

  double worst_row_px = 0, worst_place_m = 0;
  int joints = 0;
  for (const auto& frame : truth["frames"])
    for (const auto& joint : frame["joints"]) {
      if (!joint["in_left"] || !joint["in_right"]) continue;
      const Vec2 raw_left = {joint["uv_left"][0], joint["uv_left"][1]},
                 raw_right = {joint["uv_right"][0], joint["uv_right"][1]};
      const auto a = rectified_from_raw(geometry, geometry.rig_from_left, left, raw_left);
      const auto b = rectified_from_raw(geometry, geometry.rig_from_right, right, raw_right);
      ASSERT_TRUE(a && b);
      ++joints;
      worst_row_px = std::max(worst_row_px, std::abs(a->y - b->y));
      const Vec3 p_in_left_m = {joint["xyz"][0], joint["xyz"][1], joint["xyz"][2]};
      const Vec3 p_in_rig_m = geometry.rig_from_left * p_in_left_m;
      worst_place_m = std::max(worst_place_m, norm(geometry.triangulate(*a, a->x - b->x) - p_in_rig_m));
      if (well_inside(raw_left, rig->left.size) && well_inside(raw_right, rig->right.size)) {
        EXPECT_TRUE(inside(r->left, *a) && inside(r->right, *b)) << a->x << " " << a->y << " " << b->x;
      }
    }
  EXPECT_GT(joints, 500);
  EXPECT_LT(worst_row_px, 0.05);
  EXPECT_LT(worst_place_m, 0.001);
  std::printf("%s: canvas %dx%d, %d joints, rows differ by at most %.4f px, places by %.2f mm\n", GetParam(),
              geometry.size.width, geometry.size.height, joints, worst_row_px, 1000 * worst_place_m);
}

INSTANTIATE_TEST_SUITE_P(Rendered, Clips, testing::Values("dev_easy_wave", "dev_hard_beige"));

}  // namespace
}  // namespace duo
