// Rig files that people bring: OpenCV's in all three syntaxes and in two files, drivers' half-filled ones, data sets, ZED.
#include <gtest/gtest.h>

#include <cmath>
#include <opencv2/core/persistence.hpp>

#include "core/lens.h"
#include "duoptic/rig_files.h"
#include "tests/refused_rig.h"
#include "tests/replaced.h"
#include "tests/write_media.h"

namespace duo {
namespace {

using test::expect_refused;
using test::put;
using test::replaced;
using test::TempFolder;

constexpr char kOpencv[] = R"(%YAML:1.0
---
image_width: 640
image_height: 480
M1: !!opencv-matrix
   rows: 3
   cols: 3
   dt: d
   data: [ 560, 0, 323, 0, 561, 236, 0, 0, 1 ]
D1: !!opencv-matrix
   rows: 1
   cols: 5
   dt: d
   data: [ -0.08, 0.05, 0.0005, -0.0004, 0.01 ]
M2: !!opencv-matrix
   rows: 3
   cols: 3
   dt: d
   data: [ 563, 0, 315, 0, 564, 243, 0, 0, 1 ]
D2: !!opencv-matrix
   rows: 1
   cols: 5
   dt: d
   data: [ -0.07, 0.04, 0.0003, -0.0002, 0.02 ]
R: [ 0.96, -0.28, 0, 0.28, 0.96, 0, 0, 0, 1 ]
T: [ -0.12, 0.001, 0.002 ]
)";

void expect_the_rig(const Rig& rig) {
  EXPECT_EQ(rig.left, (Camera{{640, 480}, 560, 561, 323, 236, {-0.08, 0.05, 0.0005, -0.0004, 0.01}}));
  EXPECT_EQ(rig.right, (Camera{{640, 480}, 563, 564, 315, 243, {-0.07, 0.04, 0.0003, -0.0002, 0.02}}));
  EXPECT_EQ(rig.right_from_left.rotation(0, 1), -0.28);
  EXPECT_EQ(rig.right_from_left.t_m, (Vec3{-0.12, 0.001, 0.002}));
}

/// OpenCV's own storage of the same rig.
std::string written_by_opencv(const char* ending) {
  cv::FileStorage storage(ending, cv::FileStorage::WRITE | cv::FileStorage::MEMORY);
  const auto put_matrix = [&](const char* key, int rows, std::vector<double> numbers) {
    storage << key << cv::Mat(numbers).reshape(1, rows);
  };
  storage << "image_width" << 640 << "image_height" << 480 << "calibration_time"
          << "some day";
  put_matrix("M1", 3, {560, 0, 323, 0, 561, 236, 0, 0, 1});
  put_matrix("D1", 1, {-0.08, 0.05, 0.0005, -0.0004, 0.01});
  put_matrix("M2", 3, {563, 0, 315, 0, 564, 243, 0, 0, 1});
  put_matrix("D2", 5, {-0.07, 0.04, 0.0003, -0.0002, 0.02});
  put_matrix("R", 3, {0.96, -0.28, 0, 0.28, 0.96, 0, 0, 0, 1});
  put_matrix("T", 3, {-0.12, 0.001, 0.002});
  return storage.releaseAndGetString();
}

TEST(RigImports, ReadsAllThreeSyntaxesOfOpencv) {
  for (const std::string& text :
       {std::string(kOpencv), written_by_opencv(".yml"), written_by_opencv(".json"), written_by_opencv(".xml")}) {
    const auto rig = parse_rig(text, "opencv");
    ASSERT_TRUE(rig) << rig.error().what << '\n' << text;
    expect_the_rig(*rig);
  }
  const std::string xml = written_by_opencv(".xml");
  expect_refused(xml.substr(0, xml.size() / 2), "XML is broken or cut short");
  expect_refused("<html><body>404</body></html>", "this XML is not OpenCV's");
  expect_refused(replaced(xml, "<M1 ", "<M9 ").replace(xml.find("</M1>"), 5, "</M9>"), "key 'M1' is missing");
  expect_refused(replaced(xml, "<rows>3</rows>", "<rows>3</rows><data>a b</data>"), "key 'M1' is not a matrix");
}

// OpenCV's Python gives 14 numbers (flags or not), its C++ an empty matrix for a lens without distortion.
TEST(RigImports, TakesAnyLengthOfUnusedCoefficients) {
  const std::string good = kOpencv, d1 = "[ -0.08, 0.05, 0.0005, -0.0004, 0.01 ]";
  const auto distortion = [&](const std::string& list) {
    const auto rig = parse_rig(replaced(good, d1, list), "opencv");
    EXPECT_TRUE(rig) << rig.error().what;
    return rig ? rig->left.distortion : std::array<double, 8>{9};
  };
  EXPECT_EQ(distortion("[ ]"), (std::array<double, 8>{}));
  EXPECT_EQ(distortion("[ 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0, 0, 0, 0 ]"),
            (std::array<double, 8>{0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8}));
  EXPECT_EQ(distortion("[ 0.1, 0.2, 0.3, 0.4, 0.5, 0, 0, 0, 0, 0, 0, 0, 0, 0 ]"),
            (std::array<double, 8>{0.1, 0.2, 0.3, 0.4, 0.5}));
  expect_refused(replaced(good, d1, "[ 0.1, 0.2, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0.01 ]"), "after the eighth");
  expect_refused(replaced(good, d1, "[ 0.1, 0.2, 0, 0, 0, 0, 0, 0, 0.003, 0, 0, 0 ]"), "after the eighth");
  expect_refused(replaced(good, d1, "[ 0.1, 0.2, 0 ]"), "has 3 numbers");
}

TEST(RigImports, RefusesOtherLensesByTheirName) {
  const std::string good = kOpencv;
  for (const char* line : {"fisheye_model: 1", "calibration_model: fisheye", "camera_model: Equidistant", "model_type: omni"})
    expect_refused(good + line + "\n", "is not read; calibrate with a pinhole model");
  for (const char* line : {"fisheye_model: 0", "calibration_model: pinhole", "nothing: fisheye"})
    EXPECT_TRUE(parse_rig(good + line + "\n", "opencv")) << line;
  const std::string json = written_by_opencv(".json");
  expect_refused(replaced(json, "\"image_width\"", "\"fisheye_model\": 1, \"image_width\""), "lens model 'fisheye'");
}

TEST(RigImports, ReadsIntrinsicsAndExtrinsics) {
  const TempFolder folder;
  const std::string all = kOpencv, head = "%YAML:1.0\n---\n";
  const std::size_t cameras = all.find("M1:"), pose = all.find("R:");
  put(folder / "intrinsics.yml", head + all.substr(cameras, pose - cameras));
  put(folder / "extrinsics.yml", head + all.substr(pose) + "R1: [ 1, 0, 0, 0, 1, 0, 0, 0, 1 ]\n");
  for (const bool swapped : {false, true}) {
    const auto read = swapped ? import_rig(folder / "extrinsics.yml", folder / "intrinsics.yml")
                              : import_rig(folder / "intrinsics.yml", folder / "extrinsics.yml");
    ASSERT_TRUE(read) << read.error().what;
    expect_the_rig(read->rig);
    EXPECT_NE(read->note.find("640x480 is taken"), std::string::npos) << read->note;
  }
  const auto told = import_rig(folder / "intrinsics.yml", folder / "extrinsics.yml", {672, 480});
  ASSERT_TRUE(told) << told.error().what;
  EXPECT_EQ(told->rig.left.size, (Size{672, 480}));
  EXPECT_EQ(told->note, "");

  // A centre in the middle of no usual picture, or of two, is not guessed.
  put(folder / "odd.yml", replaced(head + all.substr(cameras, pose - cameras), "323, 0, 561, 236", "140, 0, 561, 236"));
  const auto odd = import_rig(folder / "odd.yml", folder / "extrinsics.yml");
  ASSERT_FALSE(odd);
  EXPECT_NE(odd.error().what.find("--size"), std::string::npos) << odd.error().what;
  for (const char* alone : {"intrinsics.yml", "extrinsics.yml"}) {
    const auto half = load_rig(folder / alone);
    ASSERT_FALSE(half);
    EXPECT_NE(half.error().what.find("intrinsics.yml extrinsics.yml"), std::string::npos) << half.error().what;
  }
}

// As tutorials name them, and as MATLAB exports them.
TEST(RigImports, ReadsOtherNamesOfCameraMatrices) {
  const std::string good = kOpencv;
  const auto renamed = [&](const char* m1, const char* d1, const char* m2, const char* d2) {
    return replaced(replaced(replaced(replaced(good, "M1:", m1), "D1:", d1), "M2:", m2), "D2:", d2);
  };
  for (const std::string& text : {renamed("K1:", "D1:", "K2:", "D2:"), renamed("mtxL:", "distL:", "mtxR:", "distR:"),
                                  renamed("K_left:", "D_left:", "K_right:", "D_right:")}) {
    const auto rig = parse_rig(text, "opencv");
    ASSERT_TRUE(rig) << rig.error().what << text;
    expect_the_rig(*rig);
  }
  expect_refused(renamed("A:", "B:", "C:", "D:"), "has a pose, but no camera matrices");
  expect_refused(
      R"({"image_size": [640, 480], "M1": [[560,0,0],[0,561,0],[323,236,1]], "D1": [0,0,0,0,0], "M2": [[560,0,0],[0,561,0],[323,236,1]],
          "D2": [0,0,0,0,0], "R": [[1,0,0],[0,1,0],[0,0,1]], "T": [-0.12,0,0]})",
      "as MATLAB writes it: transpose it");
}

TEST(RigImports, TextsOfOtherProgramsAreNotCalledBroken) {
  expect_refused(
      "Calibration results\n====================\nCamera-system parameters:\ncam0 (/cam0/image_raw):\n    type: <class>\n",
      "no rig file of a known kind");
  expect_refused("Extrinsic from \"Infrared 1\" To \"Infrared 2\":\n Rotation Matrix:\n 1 0 0\n Translation Vector: 0 0\n",
                 "no rig file of a known kind");
  expect_refused("cam0:\n  intrinsics: [1, 2\n", "broken or cut short");
}

constexpr char kRos[] = R"(height: 480
width: 640
distortion_model: plumb_bob
d: []
k: [500.0, 0.0, 320.0, 0.0, 501.0, 240.0, 0.0, 0.0, 1.0]
r: [0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0]
p: [500.0, 0.0, 320.0, 0.0, 0.0, 501.0, 240.0, 0.0, 0.0, 0.0, 1.0, 0.0]
)";

TEST(RigImports, ReadsRosMessagesOfRectifiedPictures) {
  const std::string left = kRos, right = replaced(left, "p: [500.0, 0.0, 320.0, 0.0", "p: [500.0, 0.0, 320.0, -50.0");
  for (const char* model : {"plumb_bob", "''"}) {
    const auto rig = parse_rig(replaced(left, "plumb_bob", model) + "---\n" + replaced(right, "plumb_bob", model), "ros");
    ASSERT_TRUE(rig) << rig.error().what;
    EXPECT_EQ(rig->left, (Camera{{640, 480}, 500, 501, 320, 240}));
    EXPECT_EQ(rig->right_from_left, (Rigid3{{}, {-0.1, 0, 0}}));
  }
  expect_refused(left + "---\n" + replaced(right, "d: []", "d: [0,0,0,0,0,0,0,0,0,0,0,1]"), "after the eighth");
  expect_refused(left + "---\n" + replaced(right, "plumb_bob", "''").replace(right.find("d: []") - 7, 5, "d: [1, 2, 3, 4, 5]"),
                 "distortion model ''");
}

TEST(RigImports, RefusesRosMessagesOfPartsOfTheSensor) {
  const std::string left = kRos, right = replaced(left, "p: [500.0, 0.0, 320.0, 0.0", "p: [500.0, 0.0, 320.0, -50.0");
  const auto with = [&](const std::string& more) { return left + more + "---\n" + right; };
  for (const char* whole : {"binning_x: 0\nbinning_y: 0\nroi:\n  x_offset: 0\n  width: 0\n  height: 0\n", "binning_x: 1\n",
                            "roi:\n  x_offset: 0\n  y_offset: 0\n  width: 640\n  height: 480\n"})
    EXPECT_TRUE(parse_rig(with(whole), "ros")) << whole;
  expect_refused(with("binning_x: 2\nbinning_y: 2\n"), "left camera: its pictures are binned");
  for (const char* part : {"  x_offset: 100\n  width: 300\n  height: 200\n", "  width: 640\n  height: 400\n",
                           "  width: 600\n  height: 0\n", "  y_offset: 8\n  width: 640\n  height: 480\n"})
    expect_refused(with(std::string("roi:\n") + part), "of a part of the sensor");
}

TEST(RigImports, ReadsMiddlebury) {
  const auto rig = parse_rig(
      "cam0=[3979.911 0 1244.772; 0 3979.911 1019.507; 0 0 1]\ncam1=[3979.911 0 1369.115; 0 3979.911 "
      "1019.507; 0 0 1]\r\ndoffs=124.343\nbaseline=193.001\nwidth=2964\nheight=1988\nndisp=270\n",
      "calib.txt");
  ASSERT_TRUE(rig) << rig.error().what;
  EXPECT_EQ(rig->left, (Camera{{2964, 1988}, 3979.911, 3979.911, 1244.772, 1019.507}));
  EXPECT_EQ(rig->right.cx_px, 1369.115);
  EXPECT_NEAR(rig->right_from_left.t_m.x, -0.193001, 1e-12);
  expect_refused("cam0=[1 0 1; 0 1 1; 0 0 1]\nwidth=10\nheight=10\nbaseline=100\n", "key 'cam1' is missing");
  expect_refused("cam0=[1 0 1; 0 1 1]\nwidth=10\nheight=10\nbaseline=100\n", "key 'cam0' has 6 numbers, not 9");
  expect_refused("cam0=[1 0 1; 0 1 1; 0 0 1]\ncam1=[1 0 1; 0 1 1; 0 0 1]\nwidth=10.5\nheight=10\nbaseline=1\n", "10.5 px");
}

TEST(RigImports, ReadsKitti) {
  const std::string p2 = "7.215377e+02 0.000000e+00 6.095593e+02 4.485728e+01 0.000000e+00 7.215377e+02 1.728540e+02 "
                         "2.163791e-01 0.000000e+00 0.000000e+00 1.000000e+00 2.745884e-03\n",
                    p3 = "7.215377e+02 0.000000e+00 6.095593e+02 -3.395242e+02 0.000000e+00 7.215377e+02 1.728540e+02 "
                         "2.199936e+00 0.000000e+00 0.000000e+00 1.000000e+00 2.729905e-03\n";
  const std::string raw =
      "calib_time: 09-Jan-2012 13:57:47\nS_rect_02: 1.242000e+03 3.750000e+02\nP_rect_02: " + p2 + "P_rect_03: " + p3;
  const TempFolder folder;
  put(folder / "calib_cam_to_cam.txt", raw);
  put(folder / "calib.txt", "P0: " + p2 + "P1: " + p2 + "P2: " + p2 + "P3: " + p3);
  for (const auto& read : {import_rig(folder / "calib_cam_to_cam.txt"), import_rig(folder / "calib.txt", {}, {1242, 375})}) {
    ASSERT_TRUE(read) << read.error().what;
    EXPECT_EQ(read->rig.left, (Camera{{1242, 375}, 721.5377, 721.5377, 609.5593, 172.854}));
    EXPECT_NEAR(read->rig.right_from_left.t_m.x, -(44.85728 + 339.5242) / 721.5377, 1e-12);
  }
  put(folder / "gray.txt", "P0: " + p2 + "P1: " + p3);  // the odometry's gray pictures
  const auto gray = import_rig(folder / "gray.txt", {}, {1242, 375});
  ASSERT_TRUE(gray) << gray.error().what;
  EXPECT_EQ(gray->rig.left_name, "KITTI camera 0");
  EXPECT_NEAR(gray->rig.right_from_left.t_m.x, -(44.85728 + 339.5242) / 721.5377, 1e-12);
  const auto unsized = load_rig(folder / "calib.txt");
  ASSERT_FALSE(unsized);
  EXPECT_NE(unsized.error().what.find("--size"), std::string::npos) << unsized.error().what;
  expect_refused(raw.substr(0, raw.find("P_rect_03")), "key 'P_rect_03' is missing");
}

constexpr char kZed[] = R"([LEFT_CAM_HD]
fx=700.1
fy=700.2
cx=640.5
cy=360.25
k1=-0.17
k2=0.027

[RIGHT_CAM_HD]
fx=701.1
fy=701.2
cx=650.5
cy=350.25
k1=-0.16
k2=0.026
p1=0.001
p2=0.002
k3=0.003

[LEFT_CAM_VGA]
fx=350
[STEREO]
Baseline=120
TY=0.5
TZ=-0.25
CV_HD=0.03
RX_HD=0.02
RZ_HD=0.01
)";

TEST(RigImports, ReadsZed) {
  const TempFolder folder;
  put(folder / "SN1.conf", kZed);
  const auto read = import_rig(folder / "SN1.conf", {}, {1280, 720});
  ASSERT_TRUE(read) << read.error().what;
  EXPECT_EQ(read->rig.left, (Camera{{1280, 720}, 700.1, 700.2, 640.5, 360.25, {-0.17, 0.027}}));
  EXPECT_EQ(read->rig.right.distortion, (std::array<double, 8>{-0.16, 0.026, 0.001, 0.002, 0.003}));
  EXPECT_NEAR(norm(read->rig.right_from_left.t_m - Vec3{-0.12, -0.0005, 0.00025}), 0, 1e-12);
  // Of a small turn (x, y, z) the matrix is [1 -z y; z 1 -x; -y x 1] but for the products of two of them.
  const Mat3& r = read->rig.right_from_left.rotation;
  EXPECT_NEAR((r(2, 1) - r(1, 2)) / 2, 0.02, 1e-4);
  EXPECT_NEAR((r(0, 2) - r(2, 0)) / 2, 0.03, 1e-4);
  EXPECT_NEAR((r(1, 0) - r(0, 1)) / 2, 0.01, 1e-4);
  for (const auto& wrong : {load_rig(folder / "SN1.conf"), parse_rig(kZed, "SN1.conf")}) {
    ASSERT_FALSE(wrong);
    EXPECT_NE(wrong.error().what.find("(1280x720, 672x376)"), std::string::npos) << wrong.error().what;
    EXPECT_NE(wrong.error().what.find("--size"), std::string::npos);
  }
  const auto half = import_rig(folder / "SN1.conf", {}, {672, 376});
  ASSERT_FALSE(half);
  EXPECT_NE(half.error().what.find("LEFT_CAM_VGA.fy"), std::string::npos) << half.error().what;
}

TEST(RigImports, NamesFilesThatAreNoText) {
  expect_refused(std::string("PK\x03\x04\x14\0\0\0", 8), "NumPy's .npz");
  expect_refused("\x1F\x8B\x08", "gzip");
  expect_refused("\x93NUMPY", ".npy");
  expect_refused("MATLAB 5.0 MAT-file", ".mat");
}

}  // namespace
}  // namespace duo
