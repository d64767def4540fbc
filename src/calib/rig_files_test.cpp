// Rigs of other programs: what they write is read, what we write they read, and a rig comes back as it was.
#include "duoptic/rig_files.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <opencv2/core/persistence.hpp>

#include "calib/opencv_rectified.h"
#include "calib/rectification.h"
#include "core/lens.h"
#include "duoptic/synthetic.h"
#include "tests/refused_rig.h"
#include "tests/replaced.h"
#include "tests/write_media.h"

namespace duo {
namespace {

using test::bytes_of;
using test::expect_refused;
using test::put;
using test::replaced;
using test::TempFolder;

Rig plain_rig() {
  Rig rig = synthetic_rig({.size = {640, 480}});
  rig.left.distortion = {-0.118, 0.062, 8e-4, -1.1e-3, 0, 0, 0, 0};
  rig.right.distortion = {-0.109, 0.041, -6e-4, 9e-4, 0, 0, 0, 0};
  return rig;
}
Rig with_k3() {
  Rig rig = plain_rig();
  rig.left.distortion[4] = 0.03;
  return rig;
}
Rig rational() {
  Rig rig = with_k3();
  rig.right.distortion = {-0.2, 0.05, -6e-4, 9e-4, 0.01, -0.1, 0.02, 0.003};
  return rig;
}

void expect_near(const Camera& a, const Camera& b) {
  EXPECT_EQ(a.size, b.size);
  EXPECT_NEAR(a.fx_px, b.fx_px, 1e-9);
  EXPECT_NEAR(a.fy_px, b.fy_px, 1e-9);
  EXPECT_NEAR(a.cx_px, b.cx_px, 1e-9);
  EXPECT_NEAR(a.cy_px, b.cy_px, 1e-9);
  for (std::size_t i = 0; i < 8; ++i) EXPECT_NEAR(a.distortion[i], b.distortion[i], 1e-9) << "coefficient " << i;
}

void expect_near(const Rig& a, const Rig& b) {
  expect_near(a.left, b.left);
  expect_near(a.right, b.right);
  for (std::size_t i = 0; i < 9; ++i) EXPECT_NEAR(a.right_from_left.rotation.m[i], b.right_from_left.rotation.m[i], 1e-9);
  EXPECT_LT(norm(a.right_from_left.t_m - b.right_from_left.t_m), 1e-9);
}

struct RoundTrip {
  RigFormat format;
  const char* file;
};
class RoundTrips : public testing::TestWithParam<RoundTrip> {};

TEST_P(RoundTrips, ComesBackAsItWas) {
  const TempFolder folder;
  for (const Rig& rig : {plain_rig(), with_k3(), rational()}) {
    const auto exported = export_rig(rig, GetParam().format, folder / GetParam().file);
    ASSERT_TRUE(exported) << exported.error().what;
    for (const auto& file : exported->files) EXPECT_TRUE(std::filesystem::is_regular_file(file)) << file;
    const auto back = import_rig(folder / GetParam().file);
    ASSERT_TRUE(back) << back.error().what;
    expect_near(back->rig, rig);
  }
}

INSTANTIATE_TEST_SUITE_P(Formats, RoundTrips,
                         testing::Values(RoundTrip{RigFormat::kOpencv, "rig.yml"}, RoundTrip{RigFormat::kOpencv, "rig.yaml"},
                                         RoundTrip{RigFormat::kOpencv, "rig.json"}, RoundTrip{RigFormat::kRos, "rig.yaml"},
                                         RoundTrip{RigFormat::kRos, "folder"}, RoundTrip{RigFormat::kKalibr, "camchain.yaml"}));

TEST(RigFiles, OpencvReadsWhatWeWriteForIt) {
  const TempFolder folder;
  const Rig rig = rational();
  const OpencvRectified rectified = opencv_rectified(rig);
  for (const char* file : {"rig.yml", "rig.json"}) {
    ASSERT_TRUE(export_rig(rig, RigFormat::kOpencv, folder / file));
    const cv::FileStorage storage((folder / file).string(), cv::FileStorage::READ);
    ASSERT_TRUE(storage.isOpened());
    EXPECT_EQ(static_cast<int>(storage["image_width"]), 640);
    EXPECT_EQ(static_cast<int>(storage["image_height"]), 480);
    const auto matrix = [&](const char* key, int rows, int cols) {
      cv::Mat m;
      storage[key] >> m;
      EXPECT_TRUE(m.rows == rows && m.cols == cols && m.type() == CV_64F) << key;
      return m.empty() ? cv::Mat(4, 14, CV_64F, cv::Scalar(NAN)) : m;
    };
    EXPECT_NEAR(matrix("M1", 3, 3).at<double>(0, 2), rig.left.cx_px, 1e-9);
    EXPECT_NEAR(matrix("M2", 3, 3).at<double>(1, 1), rig.right.fy_px, 1e-9);
    EXPECT_NEAR(matrix("D1", 1, 5).at<double>(0, 4), 0.03, 1e-12);
    EXPECT_NEAR(matrix("D2", 1, 8).at<double>(0, 7), 0.003, 1e-12);
    EXPECT_NEAR(matrix("R", 3, 3).at<double>(0, 2), rig.right_from_left.rotation(0, 2), 1e-12);
    EXPECT_NEAR(matrix("T", 3, 1).at<double>(0, 0), rig.right_from_left.t_m.x, 1e-12);
    EXPECT_NEAR(matrix("R1", 3, 3).at<double>(2, 0), rectified.r1(2, 0), 1e-12);
    EXPECT_NEAR(matrix("R2", 3, 3).at<double>(0, 1), rectified.r2(0, 1), 1e-12);
    const double focal_px = matrix("P1", 3, 4).at<double>(0, 0);
    EXPECT_NEAR(matrix("P2", 3, 4).at<double>(0, 3), -focal_px * rig.baseline_m(), 1e-9);
    EXPECT_NEAR(matrix("Q", 4, 4).at<double>(2, 3), focal_px, 1e-9);
  }
}

// The rectified pictures have no lens left, and the right camera lies a baseline to the right.
TEST(RigFiles, RosGetsTheRectifiedPictures) {
  const TempFolder folder;
  const Rig rig = rational();
  ASSERT_TRUE(export_rig(rig, RigFormat::kRosRectified, folder / "rectified"));
  const auto back = import_rig(folder / "rectified");
  ASSERT_TRUE(back) << back.error().what;
  const auto geometry = rectified_geometry(rig, "rig");
  ASSERT_TRUE(geometry);
  for (const Camera& camera : {back->rig.left, back->rig.right}) {
    EXPECT_EQ(camera.size, geometry->size);
    EXPECT_NEAR(camera.fx_px, geometry->focal_px, 1e-9);
    EXPECT_NEAR(camera.fy_px, geometry->focal_px, 1e-9);
    EXPECT_NEAR(camera.cx_px, geometry->cx_px, 1e-9);
    EXPECT_NEAR(camera.cy_px, geometry->cy_px, 1e-9);
    EXPECT_EQ(camera.distortion, (std::array<double, 8>{}));
  }
  EXPECT_EQ(back->rig.right_from_left.rotation, Mat3{});
  EXPECT_NEAR(back->rig.right_from_left.t_m.x, -rig.baseline_m(), 1e-12);
  EXPECT_NEAR(norm(back->rig.right_from_left.t_m), rig.baseline_m(), 1e-12);
}

// A lens with k3 or a denominator has no exact radtan: what Kalibr sees stays within the error that is told.
TEST(RigFiles, KalibrGetsTheNearestLens) {
  const TempFolder folder;
  const auto exact = export_rig(plain_rig(), RigFormat::kKalibr, folder / "plain.yaml");
  ASSERT_TRUE(exact);
  EXPECT_EQ(exact->lens_error_px, 0);
  EXPECT_EQ(bytes_of(folder / "plain.yaml").find("duoptic"), std::string::npos);

  const Rig rig = rational();
  const auto fitted = export_rig(rig, RigFormat::kKalibr, folder / "rational.yaml");
  ASSERT_TRUE(fitted);
  EXPECT_GT(fitted->lens_error_px, 0);
  EXPECT_LT(fitted->lens_error_px, 1);
  std::string text = bytes_of(folder / "rational.yaml");
  for (std::size_t at; (at = text.find("duoptic_distortion")) != text.npos;) text.replace(at, 7, "another");
  const auto seen_by_kalibr = parse_rig(text, "kalibr");
  ASSERT_TRUE(seen_by_kalibr) << seen_by_kalibr.error().what;
  const Lens ours(rig.right), theirs(seen_by_kalibr->right);
  for (double x = 0; x < 640; x += 40)
    for (double y = 0; y < 480; y += 40) {
      const auto again = theirs.pixel_of(*ours.ray_of({x, y}));
      ASSERT_TRUE(again);
      EXPECT_LE(std::max(std::abs(again->x - x), std::abs(again->y - y)), fitted->lens_error_px + 1e-9);
    }
}

constexpr char kCamchain[] = R"(cam0:
  cam_overlaps: [1]
  camera_model: pinhole
  distortion_coeffs: [-0.294719325148729, 0.08601391290708914, -0.0003238494917967103, -0.00041999959826033857]
  distortion_model: radtan
  intrinsics: [461.1587854297, 459.7529120717, 362.6593163122, 246.0661742154]
  resolution: [752, 480]
  rostopic: /cam0/image_raw
cam1:
  T_cn_cnm1:
  - [0.9999974202424761, 0.0005045392069314, 0.0022146978924107, -0.1100749205862427]
  - [-0.0004743889172447, 0.9999073137366, -0.013607266124957, 0.0003991214457245]
  - [-0.0022213579346, 0.0136061794744, 0.9999049666, -0.00085371935168]
  - [0.0, 0.0, 0.0, 1.0]
  cam_overlaps: [0]
  camera_model: pinhole
  distortion_coeffs: [-0.293163599512, 0.08423888355, -0.00016297, -0.00011549]
  distortion_model: radtan
  intrinsics: [460.8, 459.5, 368.8, 253.9]
  resolution: [752, 480]
  rostopic: /cam1/image_raw
)";

constexpr char kLeftInfo[] = R"(image_width: 640
image_height: 480
camera_name: narrow_stereo/left
camera_matrix:
  rows: 3
  cols: 3
  data: [500.0, 0.0, 320.0, 0.0, 501.0, 240.0, 0.0, 0.0, 1.0]
distortion_model: plumb_bob
distortion_coefficients:
  rows: 1
  cols: 5
  data: [-0.1, 0.02, 0.001, -0.002, 0.0]
rectification_matrix:
  rows: 3
  cols: 3
  data: [1, 0, 0, 0, 1, 0, 0, 0, 1]
projection_matrix:
  rows: 3
  cols: 4
  data: [490.0, 0.0, 318.0, 0.0, 0.0, 490.0, 241.0, 0.0, 0.0, 0.0, 1.0, 0.0]
)";
// A message as `ros2 topic echo` prints it; the right camera is turned by 90 degrees around z, its x axis down.
constexpr char kRightInfo[] = R"(header:
  frame_id: right
height: 480
width: 640
distortion_model: rational_polynomial
d: [0.1, 0.2, 0.0, 0.0, 0.3, 0.4, 0.5, 0.6]
k: [510.0, 0.0, 321.0, 0.0, 511.0, 241.0, 0.0, 0.0, 1.0]
r: [1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0]
p: [490.0, 0.0, 318.0, -58.8, 0.0, 490.0, 241.0, 0.0, 0.0, 0.0, 1.0, 0.0]
binning_x: 0
)";

TEST(RigFiles, ReadsKalibr) {
  const auto rig = parse_rig(kCamchain, "camchain.yaml");
  ASSERT_TRUE(rig) << rig.error().what;
  EXPECT_EQ(rig->left.size, (Size{752, 480}));
  EXPECT_EQ(rig->left.fy_px, 459.7529120717);
  EXPECT_EQ(rig->right.cx_px, 368.8);
  EXPECT_EQ(rig->right.distortion, (std::array<double, 8>{-0.293163599512, 0.08423888355, -0.00016297, -0.00011549}));
  EXPECT_EQ(rig->right_from_left.rotation(1, 2), -0.013607266124957);
  EXPECT_EQ(rig->right_from_left.t_m, (Vec3{-0.1100749205862427, 0.0003991214457245, -0.00085371935168}));
}

TEST(RigFiles, ReadsRosFilesAndMessages) {
  const TempFolder folder;
  put(folder / "left.yaml", kLeftInfo);
  put(folder / "right.yaml", kRightInfo);
  put(folder / "both.yaml", std::string(kLeftInfo) + "---\n" + kRightInfo + "---\n");
  for (const auto& read :
       {import_rig(folder / "left.yaml", folder / "right.yaml"), import_rig(folder / ""), import_rig(folder / "both.yaml")}) {
    ASSERT_TRUE(read) << read.error().what;
    const Rig* rig = &read->rig;
    EXPECT_EQ(rig->left, (Camera{{640, 480}, 500, 501, 320, 240, {-0.1, 0.02, 0.001, -0.002, 0, 0, 0, 0}}));
    EXPECT_EQ(rig->right, (Camera{{640, 480}, 510, 511, 321, 241, {0.1, 0.2, 0, 0, 0.3, 0.4, 0.5, 0.6}}));
    EXPECT_NEAR(rig->right_from_left.t_m.x, -0.12, 1e-12);
    EXPECT_EQ(rig->left_name, "narrow_stereo/left");
  }
}

// The rotation is the right camera's rectification, undone, after the left one's: R2^T R1.
TEST(RigFiles, RosPoseComesFromTheRectification) {
  const std::string left = replaced(kLeftInfo, "[1, 0, 0, 0, 1, 0, 0, 0, 1]", "[1, 0, 0, 0, 0.8, -0.6, 0, 0.6, 0.8]");
  const std::string right = replaced(kRightInfo, "r: [1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0]",
                                     "r: [0.96, 0.28, 0.0, -0.28, 0.96, 0.0, 0.0, 0.0, 1.0]");
  const auto rig = parse_rig(left + "---\n" + right, "ros");
  ASSERT_TRUE(rig) << rig.error().what;
  const double expected[] = {0.96, -0.28 * 0.8, 0.28 * 0.6, 0.28, 0.96 * 0.8, -0.96 * 0.6, 0, 0.6, 0.8};
  for (std::size_t i = 0; i < 9; ++i) EXPECT_NEAR(rig->right_from_left.rotation.m[i], expected[i], 1e-12) << i;
  EXPECT_NEAR(rig->right_from_left.t_m.x, -0.12 * 0.96, 1e-12);
  EXPECT_NEAR(rig->right_from_left.t_m.y, -0.12 * 0.28, 1e-12);
}

TEST(RigFiles, RefusesOtherKalibrFiles) {
  const std::string good = kCamchain;
  expect_refused(good.substr(0, good.find("cam1:")), "cam1 is missing");
  expect_refused(good + "cam2: {}\n", "more than two cameras");
  expect_refused(replaced(good, "radtan", "equidistant"), "cam0: distortion model 'equidistant' is not read");
  expect_refused(replaced(good, "pinhole", "omni"), "cam0: camera model 'omni' is not read");
  expect_refused(replaced(good, "camera_model: pinhole", "camera_model: [1]"),
                 "cam0: key 'camera_model' is missing or no text");
  expect_refused(replaced(good, "[752, 480]", "[752]"), "cam0: key 'resolution' has 1 numbers");
  expect_refused(replaced(good, "[752, 480]", "[752.5, 480]"), "not a size");
  expect_refused(replaced(good, "[461.1587854297,", "["), "cam0: key 'intrinsics' has 3 numbers");
  expect_refused(replaced(good, "T_cn_cnm1", "T_cam_imu"), "cam1: key 'T_cn_cnm1' is missing");
  expect_refused(replaced(good, "[0.0, 0.0, 0.0, 1.0]", "[0.0, 0.0, 0.0, 2.0]"), "last row");
  expect_refused(replaced(good, "-0.1100749205862427", "0.1100749205862427"), "swapped");
  expect_refused(replaced(good, "-0.1100749205862427", "-110.07"), "must be in metres");
  expect_refused(replaced(good, "0.9999073137366", "x"), "'T_cn_cnm1' is not a list");
  expect_refused(good.substr(0, good.find("radtan\n  intrinsics")) + "[", "cut short");
}

TEST(RigFiles, RefusesOtherRosFiles) {
  const std::string left = kLeftInfo, right = kRightInfo;
  const auto both = [](const std::string& a, const std::string& b) { return a + "---\n" + b; };
  expect_refused(left, "one camera; give both files");
  expect_refused(both(right, left), "give the left camera first");
  expect_refused(both(left, replaced(right, "-58.8", "0.0")), "no baseline");
  expect_refused(both(left, replaced(right, "-58.8", "58.8")), "swapped");
  expect_refused(both(left, replaced(right, "rational_polynomial", "equidistant")),
                 "right camera: distortion model 'equidistant'");
  expect_refused(both(left, replaced(right, "height: 480\n", "")), "right camera: key 'image_height' is missing");
  expect_refused(both(replaced(left, "500.0, 0.0,", "500.0, 1.0,"), right), "left camera: the camera matrix is not");
  expect_refused(both(left, replaced(right, "width: 640", "width: 1280")), "both must have one size");
  expect_refused(both(left, replaced(right, "r: [1.0,", "r: [2.0,")), "not orthonormal");
  expect_refused(both(left, "a: 1\n"), "right camera: key 'image_width' is missing");

  const TempFolder folder;
  put(folder / "left.yaml", left);
  put(folder / "text.yaml", "hello");
  const auto missing = import_rig(folder / "left.yaml", folder / "none.yaml");
  ASSERT_FALSE(missing);
  EXPECT_EQ(missing.error().code, ErrorCode::kNotFound);
  const auto text = import_rig(folder / "left.yaml", folder / "text.yaml");
  ASSERT_FALSE(text);
  EXPECT_NE(text.error().what.find("text.yaml"), std::string::npos);
}

TEST(RigFiles, DoesNotWriteWhatItCannot) {
  const TempFolder folder;
  Rig rig = plain_rig();
  EXPECT_FALSE(export_rig(rig, RigFormat::kOpencv, folder / "rig.xml"));
  EXPECT_FALSE(export_rig(rig, RigFormat::kKalibr, folder / "rig.json"));
  const auto nowhere = export_rig(rig, RigFormat::kRos, folder / "none" / "rig.yaml");
  ASSERT_FALSE(nowhere);
  EXPECT_EQ(nowhere.error().code, ErrorCode::kWriteFailed);
  rig.metric = false;
  const auto guess = export_rig(rig, RigFormat::kRos, folder / "rig.yaml");
  ASSERT_FALSE(guess);
  EXPECT_NE(guess.error().what.find("not metric"), std::string::npos);
  EXPECT_TRUE(std::filesystem::is_empty(folder / ""));
}

}  // namespace
}  // namespace duo
