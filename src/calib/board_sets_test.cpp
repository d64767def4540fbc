// Calibrations of the board pictures in the test data: rendered sets, whose truth is known, and real ones.
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>

#include "calib/rectification.h"
#include "duoptic/calibrate.h"
#include "duoptic/source.h"
#include "tests/data.h"
#include "tests/turned_rig.h"

namespace duo {
namespace {

namespace fs = std::filesystem;

/// Calibrates from leftNN.jpg and rightNN.jpg (`separator` before the number), every `step`-th pair.
Result<Calibration> calibrated(const fs::path& folder, const std::string& separator, double square_m, int step = 1) {
  const auto board = parse_board("chessboard:9x6", square_m);
  std::vector<fs::path> lefts;
  for (const auto& entry : fs::directory_iterator(folder))
    if (entry.path().filename().string().starts_with("left")) lefts.push_back(entry.path());
  std::sort(lefts.begin(), lefts.end());
  std::optional<Calibrator> calibrator;
  for (std::size_t i = 0; i < lefts.size(); i += static_cast<std::size_t>(step)) {
    const std::string name = lefts[i].filename().string();
    DUO_TRY_ASSIGN(const auto source, open_pairs(lefts[i], folder / ("right" + separator + name.substr(4 + separator.size()))));
    Pair pair;
    DUO_TRY_ASSIGN([[maybe_unused]] const Next next, source->next(pair));
    if (!calibrator) calibrator.emplace(*board, pair.left.pixels.size());
    DUO_TRY(calibrator->add(pair, name));
  }
  return calibrator->solve();
}

/// Root mean square over true corners of all boards.
double corner_row_error_px(const Rig& found, const fs::path& truth_file) {
  std::ifstream file(truth_file);
  const auto truth = nlohmann::json::parse(file);
  const auto geometry = rectified_geometry(found, "found");
  EXPECT_TRUE(geometry);
  const Lens left(found.left), right(found.right);
  double sum = 0;
  int count = 0;
  for (const auto& board : truth["boards"])
    for (std::size_t i = 0; i < board["corners_left"].size(); ++i, ++count) {
      const auto &a = board["corners_left"][i], &b = board["corners_right"][i];
      const auto u = rectified_from_raw(*geometry, geometry->rig_from_left, left, {a[0], a[1]});
      const auto v = rectified_from_raw(*geometry, geometry->rig_from_right, right, {b[0], b[1]});
      EXPECT_TRUE(u && v);
      if (u && v) sum += (u->y - v->y) * (u->y - v->y);
    }
  return std::sqrt(sum / count);
}

/// How far points at this distance, all over both pictures, come out from where they are, rms: in space, and along z.
std::pair<double, double> point_errors_m(const Rig& found, const Rig& truth, double z_m) {
  const auto geometry = rectified_geometry(found, "found");
  const Lens left(found.left), right(found.right), true_left(truth.left), true_right(truth.right);
  double sum = 0, sum_z = 0;
  int count = 0;
  for (double y = -0.35; y < 0.36; y += 0.05)
    for (double x = -0.5; x < 0.51; x += 0.05) {
      const Vec3 p_m{x * z_m, y * z_m, z_m};
      const auto a = true_left.pixel_of(p_m), b = true_right.pixel_of(truth.right_from_left * p_m);
      if (!a || !b || !true_left.covers(*a) || !true_right.covers(*b)) continue;
      const auto u = rectified_from_raw(*geometry, geometry->rig_from_left, left, *a);
      const auto v = rectified_from_raw(*geometry, geometry->rig_from_right, right, *b);
      const Vec3 off_m = transposed(geometry->rig_from_left) * geometry->triangulate(*u, u->x - v->x) - p_m;
      sum += dot(off_m, off_m), sum_z += off_m.z * off_m.z, ++count;
    }
  EXPECT_GT(count, 100);
  return {std::sqrt(sum / count), std::sqrt(sum_z / count)};
}

class RenderedBoards : public testing::TestWithParam<const char*> {};

TEST_P(RenderedBoards, GiveTheTrueRigAsSurelyAsTheySay) {
  const fs::path folder = test::data_folder() / "sequences" / GetParam();
  if (!fs::exists(folder)) GTEST_SKIP() << "skipped: no data";
  const auto truth = load_rig(folder / "calibration_truth.yml");
  ASSERT_TRUE(truth) << truth.error().what;
  const auto result = calibrated(folder / "calib", "_", 0.03);
  ASSERT_TRUE(result) << result.error().what;
  const Rig& rig = result->rig;
  const double rows_px = corner_row_error_px(rig, folder / "calib" / "boards_truth.json");
  EXPECT_LE(rows_px, 0.05);
  const auto [at_150_m, z_at_150_m] = point_errors_m(rig, *truth, 1.5);
  const auto [at_200_m, z_at_200_m] = point_errors_m(rig, *truth, 2);
  EXPECT_LE(at_150_m, 0.004);
  EXPECT_LE(at_200_m, 0.007);

  const RigUncertainty& sigma = *rig.uncertainty;
  const Vec3 turned_deg = test::wrong_turn_deg(rig, *truth);
  const double off_sigmas[] = {
      (rig.left.fx_px + rig.left.fy_px - truth->left.fx_px - truth->left.fy_px) / 2 / sigma.left_focal_px,
      (rig.right.fx_px + rig.right.fy_px - truth->right.fx_px - truth->right.fy_px) / 2 / sigma.right_focal_px,
      turned_deg.x * test::kDeg / sigma.tilt_rad,
      turned_deg.y * test::kDeg / sigma.pan_rad,
      turned_deg.z * test::kDeg / sigma.roll_rad,
      (rig.baseline_m() - truth->baseline_m()) / sigma.baseline_m,
      z_at_150_m / sigma.depth_m[1],
      z_at_200_m / sigma.depth_m[2]};
  std::printf("%s: rows %.4f px, 1.5 m %.2f mm (z %.2f), 2 m %.2f mm (z %.2f); off in sigmas:", GetParam(), rows_px,
              1000 * at_150_m, 1000 * z_at_150_m, 1000 * at_200_m, 1000 * z_at_200_m);
  for (const double sigmas : off_sigmas) {
    EXPECT_LE(std::abs(sigmas), 2);
    std::printf(" %.2f", sigmas);
  }
  std::printf("\n");
}

INSTANTIATE_TEST_SUITE_P(Sets, RenderedBoards, testing::Values("dev_easy_wave", "dev_hard_beige"));

struct RealSet {
  const char* name;
  double square_m, rms_px;  // of OpenCV's stereoCalibrate, see the data's README
};

class RealBoards : public testing::TestWithParam<RealSet> {};

TEST_P(RealBoards, FitAsWellAsOpenCvFitsThem) {
  const fs::path folder = test::data_folder() / "calibration" / GetParam().name;
  if (!fs::exists(folder)) GTEST_SKIP() << "skipped: no data";
  const auto result = calibrated(folder, "", GetParam().square_m);
  ASSERT_TRUE(result) << result.error().what;
  EXPECT_LE(result->rig.reprojection_rms_px, GetParam().rms_px);
  std::printf("%s: %.3f px\n", GetParam().name, result->rig.reprojection_rms_px);
}

INSTANTIATE_TEST_SUITE_P(Sets, RealBoards,
                         testing::Values(RealSet{"opencv_640x480", 0.025, 0.22}, RealSet{"webcam_640x360", 0.02423, 0.25}));

TEST(RealBoards, OfACameraThatRefocusedAreRefused) {
  const fs::path folder = test::data_folder() / "calibration" / "person_board_1080p";
  if (!fs::exists(folder)) GTEST_SKIP() << "skipped: no data";
  const auto result = calibrated(folder, "", 0.025, 2);
  ASSERT_FALSE(result);
  EXPECT_NE(result.error().what.find("do not fit"), std::string::npos) << result.error().what;
}

}  // namespace
}  // namespace duo
