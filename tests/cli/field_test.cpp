// What people bring, as they reported it in public, rebuilt as small inputs: each through the tool, from outside.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>

#include "duoptic/rig.h"
#include "duoptic/sink.h"
#include "tests/data.h"
#include "tool.h"

namespace duo {
namespace {

namespace fs = std::filesystem;
using test::Ended;
using test::kInput;

/// One line on stderr, and it has these words.
void expect_line(const Ended& ended, const std::string& words) {
  EXPECT_EQ(std::count(ended.err.begin(), ended.err.end(), '\n'), 1) << ended.err;
  EXPECT_NE(ended.err.find(words), std::string::npos) << ended.err;
}

class Field : public ::testing::Test {
 protected:
  /// The folder of a case; skips the test where the data is not there.
  bool open(const std::string& name) {
    case_ = test::data_folder() / "field" / name;
    return fs::is_directory(case_);
  }
  std::string at(const std::string& name) const { return "'" + (case_ / name).string() + "'"; }
  fs::path out(const std::string& name = "") const { return folder_ / ("out/" + name); }
  Ended run(const std::string& arguments) const { return test::run_tool(folder_ / "", arguments); }
  /// duoptic depth of the case's files into out().
  Ended depth(const std::string& files) const { return run("depth " + files + " --max-disparity 32 -o out --json"); }

  /// In these cases a box with disparity 16 stands before a wall with disparity 6.
  void expect_box_and_wall(const fs::path& pfm) const {
    const std::string bytes = test::bytes_of(pfm);
    int width = 0, height = 0, head = 0;
    ASSERT_EQ(std::sscanf(bytes.c_str(), "Pf %d %d -1%*[^\n]%n", &width, &height, &head), 2) << pfm;
    const std::size_t pixels = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
    ASSERT_GT(bytes.size(), 4 * pixels);
    int box = 0, wall = 0;
    for (std::size_t i = 0; i < pixels; ++i) {
      float d = 0;
      std::memcpy(&d, bytes.data() + bytes.size() - 4 * pixels + 4 * i, sizeof d);
      box += std::abs(d - 16) < 1;
      wall += std::abs(d - 6) < 1;
    }
    const double n = static_cast<double>(pixels);
    EXPECT_GT(box / n, 0.04) << pfm;
    EXPECT_GT(wall / n, 0.3) << pfm;
  }
  void expect_video(const Ended& ended, int frames) const {
    EXPECT_EQ(ended.exit, 0) << ended.err;
    EXPECT_EQ(ended.json().value("frames", 0), frames) << ended.out;
    for (int i = 0; i < frames; i += std::max(1, frames / 3)) {
      char name[32];
      std::snprintf(name, sizeof name, "frame_%06d/", i);
      expect_box_and_wall(out(name + std::string("disparity.pfm")));
    }
  }

  fs::path case_;
  test::TempFolder folder_;
};

TEST_F(Field, BlankPicturesHaveNoDepth) {
  if (!open("blank_pictures")) GTEST_SKIP() << "skipped: no data";
  const Ended ended = depth(at("left.png") + " " + at("right.png"));
  EXPECT_EQ(ended.exit, 0) << ended.err;
  EXPECT_EQ(ended.json().value("coverage_percent", -1.0), 0);
}

TEST_F(Field, ADamagedPictureInAVideoIsLeftOutAndSaid) {
  if (!open("jpeg_cut_in_video")) GTEST_SKIP() << "skipped: no data";
  const Ended ended = depth(at("left.avi") + " " + at("right.avi"));
  expect_video(ended, 13);
  expect_line(ended, "1 picture of ");
  EXPECT_NE(ended.err.find("is damaged: left out"), std::string::npos) << ended.err;
  EXPECT_NE(ended.err.find("0 of 13 left pictures, 1 of 14 right ones"), std::string::npos) << ended.err;
}

TEST_F(Field, JpegsOneAfterTheOtherAreAVideo) {
  if (!open("mjpeg_stream")) GTEST_SKIP() << "skipped: no data";
  const Ended ended = depth(at("left.mjpeg") + " " + at("right.mjpeg"));
  expect_video(ended, 12);
  EXPECT_EQ(ended.err, "");
}

TEST_F(Field, AnMpoHoldsBothViews) {
  if (!open("mpo_photo")) GTEST_SKIP() << "skipped: no data";
  const Ended ended = depth(at("photo.mpo"));
  EXPECT_EQ(ended.exit, 0) << ended.err;
  expect_box_and_wall(out("disparity.pfm"));
}

TEST_F(Field, PairsAreToldByTheirNames) {
  if (!open("names_of_pairs")) GTEST_SKIP() << "skipped: no data";
  for (const std::string& folders : {at("apple"), at("capitals"), at("cams/cam0") + " " + at("cams/cam1")}) {
    const Ended ended = run("calibrate " + folders + " --quiet -o rig.json");
    EXPECT_EQ(ended.exit, kInput);
    expect_line(ended, "found in any of 2 pairs");  // their pictures show no board
  }
}

TEST_F(Field, PhotosHeldUpright) {
  if (!open("photo_exif_upright")) GTEST_SKIP() << "skipped: no data";
  const Ended ended = depth(at("left.jpg") + " " + at("right.jpg"));
  EXPECT_EQ(ended.exit, 0) << ended.err;
  EXPECT_EQ(ended.json().value("width", 0), 160);  // stored with 120 columns
  expect_box_and_wall(out("disparity.pfm"));
}

TEST_F(Field, TenBitsInSixteen) {
  if (!open("ten_bits_in_sixteen")) GTEST_SKIP() << "skipped: no data";
  const Ended ended = depth(at("left.png") + " " + at("right.png"));
  EXPECT_EQ(ended.exit, 0) << ended.err;
  expect_box_and_wall(out("disparity.pfm"));
}

TEST_F(Field, KindsOfTiffThatAreNotRead) {
  if (!open("tiff_jpeg_black")) GTEST_SKIP() << "skipped: no data";
  for (const auto& [name, words] : {std::pair("left.tif", "JPEG inside a TIFF is not supported"),
                                    {"float.tif", "floating-point values of 32 bits is not supported"},
                                    {"zstd.tif", "Zstandard compression is not supported"}}) {
    const Ended ended = depth(at(name) + " " + at("right.tif"));
    EXPECT_EQ(ended.exit, kInput);
    expect_line(ended, words);
    EXPECT_FALSE(fs::exists(out()));
  }
}

TEST_F(Field, ADimRoomMakesHalfThePicturesAndNoCut) {
  if (!open("video_dim_room")) GTEST_SKIP() << "skipped: no data";
  const Ended ended = depth(at("left.avi") + " " + at("right.avi"));
  expect_video(ended, 12);
  EXPECT_EQ(ended.err, "");
}

TEST_F(Field, VideosHeldUpright) {
  if (!open("video_phone_portrait")) GTEST_SKIP() << "skipped: no data";
  const Ended ended = depth(at("left.mp4") + " " + at("right.mp4"));
  EXPECT_EQ(ended.json().value("width", 0), 160);  // stored with 120 columns
  expect_video(ended, 8);
}

// --- Rigs -----------------------------------------------------------------------------------------------------------------

/// A rig file, or two, as `rig import` takes them.
Result<Rig> imported(const test::TempFolder& folder, const std::string& files) {
  const Ended ended = test::run_tool(folder / "", "rig import " + files + " -o rig.json");
  EXPECT_EQ(ended.exit, 0) << ended.err;
  return load_rig(folder / "rig.json");
}

TEST_F(Field, OpencvsTwoFilesAreOneRig) {
  if (!open("opencv_two_files")) GTEST_SKIP() << "skipped: no data";
  const auto rig = imported(folder_, at("intrinsics.yml") + " " + at("extrinsics.yml"));
  ASSERT_TRUE(rig);
  EXPECT_NEAR(rig->baseline_m(), 0.12, 1e-3);
  EXPECT_EQ(rig->left.size, (Size{640, 480}));
}

TEST_F(Field, FourteenCoefficientsWhoseLastAreZero) {
  if (!open("opencv_14_coefficients")) GTEST_SKIP() << "skipped: no data";
  const auto rig = imported(folder_, at("rig.yml"));
  ASSERT_TRUE(rig);
  EXPECT_NE(rig->left.distortion[0], 0);
}

TEST_F(Field, AFisheyeLensIsNotTakenForAnother) {
  if (!open("fisheye_said")) GTEST_SKIP() << "skipped: no data";
  const Ended ended = run("rig import " + at("rig.yml") + " -o rig.json");
  EXPECT_EQ(ended.exit, kInput);
  expect_line(ended, "fisheye");
}

TEST_F(Field, RosFilesThatDriversLeftEmpty) {
  if (!open("ros_unfilled")) GTEST_SKIP() << "skipped: no data";
  for (const std::string name : {"r0", "nod"}) {
    const auto rig = imported(folder_, at(name + "_left.yaml") + " " + at(name + "_right.yaml"));
    ASSERT_TRUE(rig) << name;
    EXPECT_NEAR(rig->baseline_m(), 0.1, 1e-3);
  }
}

TEST_F(Field, NearIsAFiniteDistance) {
  for (const char* value : {"0", "-1", "0,5", "nan"}) {
    const Ended ended = run("depth a.png b.png --near " + std::string(value));
    EXPECT_EQ(ended.exit, test::kUsage) << value;
    EXPECT_LT(ended.err.size(), 300U) << ended.err;
  }
}

}  // namespace
}  // namespace duo
