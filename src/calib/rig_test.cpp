#include "duoptic/rig.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <limits>

#include "calib/rig_size.h"
#include "tests/replaced.h"

namespace duo {
namespace {

namespace fs = std::filesystem;
using test::replaced;

// Cameras 12 cm apart; the right one is turned by 0.01 rad around y.
Rig good_rig() {
  Rig rig;
  rig.left = {{640, 480}, 556.3, 557.9, 322.7, 236.4, {-0.118, 0.062, 8e-4, -1.1e-3, 0.1 / 3, 0, 0, 0}};
  rig.right = {{640, 480}, 551.2, 552.4, 315.1, 243.8, {-0.109, 0.041, -6e-4, 9e-4, 0, 0, 0, 1e-300}};
  const double c = std::cos(0.01), s = std::sin(0.01);
  rig.right_from_left = {Mat3{{c, 0, s, 0, 1, 0, -s, 0, c}}, {-0.12, 1.0 / 300, -0.002}};
  rig.reprojection_rms_px = 0.21;
  rig.errors = {0.2, 0.22, 0.1 / 3, 0.25, 0.07};
  rig.uncertainty = RigUncertainty{0.7, 0.8, 1e-4, 1.0 / 3e4, 2e-5, 2e-4, {0.002, 0.0045, 0.008}};
  rig.metric = false;
  rig.time_offset_s = -0.004;
  rig.left_name = "left \"webcam\"";
  rig.right_name = "\xC3\xBC";
  rig.date = "2026-03-01T12:00:00Z";
  return rig;
}

void expect_refused(const Rig& rig, const std::string& part) {
  const auto result = check_rig(rig, "my_rig.json");
  ASSERT_FALSE(result) << "expected: " << part;
  EXPECT_NE(result.error().what.find("my_rig.json"), std::string::npos) << result.error().what;
  EXPECT_NE(result.error().what.find(part), std::string::npos) << result.error().what;
}

/// By hand: 1280x720 is 16:9; 320x240 half of 640x480.
TEST(Rig, PicturesOfAnotherSizeAreToldByTheirShape) {
  EXPECT_EQ(why_other_size(good_rig(), {640, 480}), "");
  const auto expect_words = [](Size pictures, const std::string& words) {
    const std::string why = why_other_size(good_rig(), pictures);
    EXPECT_NE(why.find(words), std::string::npos) << why;
  };
  expect_words({1280, 720}, "640x480, these have 1280x720, of another shape, so they were cropped or stretched");
  expect_words({320, 240}, "the same scaled by 0.5");
  expect_words({427, 320}, "the same scaled by 0.667");  // 426.67
  expect_words({480, 640}, "on their side");
}

void expect_text_refused(std::string_view text, const std::string& part) {
  const auto result = parse_rig(text, "my_rig.yml");
  ASSERT_FALSE(result) << "expected: " << part;
  EXPECT_NE(result.error().what.find("my_rig.yml"), std::string::npos) << result.error().what;
  EXPECT_NE(result.error().what.find(part), std::string::npos) << result.error().what;
  EXPECT_EQ(result.error().what.find('\n'), std::string::npos) << result.error().what;
}

std::string matrix_yaml(const std::string& key, int rows, int cols, const std::string& data) {
  return key + ": !!opencv-matrix\n   rows: " + std::to_string(rows) + "\n   cols: " + std::to_string(cols) +
         "\n   dt: d\n   data: [ " + data + " ]\n";
}

std::string yaml(const std::string& k1, const std::string& d1, const std::string& k2, const std::string& d2) {
  return "%YAML:1.0\n---\nimage_width: 640\nimage_height: 480\n" +
         matrix_yaml(k1, 3, 3, "500., 0., 320.,\n       0., 501., 240., 0., 0., 1.") +
         matrix_yaml(d1, 1, 5, "-1.e-01, 2.e-02, 0., 0., 3.e-03") +
         matrix_yaml(k2, 3, 3, "510., 0., 321., 0., 511., 241., 0., 0., 1.") + matrix_yaml(d2, 1, 4, "1.e-01, 0., 0., 5.e-04") +
         matrix_yaml("R", 3, 3, "1., 0., 0., 0., 1., 0., 0., 0., 1.") + matrix_yaml("T", 3, 1, "-1.2e-01, 0., 1.e-03") +
         matrix_yaml("Q", 4, 4, "1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1");
}
std::string good_yaml() { return yaml("cameraMatrix1", "distCoeffs1", "cameraMatrix2", "distCoeffs2"); }

void expect_yaml_numbers(const Result<Rig>& rig) {
  ASSERT_TRUE(rig) << rig.error().what;
  EXPECT_EQ(rig->left, (Camera{{640, 480}, 500, 501, 320, 240, {-0.1, 0.02, 0, 0, 0.003, 0, 0, 0}}));
  EXPECT_EQ(rig->right, (Camera{{640, 480}, 510, 511, 321, 241, {0.1, 0, 0, 5e-4, 0, 0, 0, 0}}));
  EXPECT_EQ(rig->right_from_left, (Rigid3{{}, {-0.12, 0, 0.001}}));
}

TEST(Rig, RoundTripKeepsEveryBit) {
  const fs::path path = fs::temp_directory_path() / "duoptic_rig_test.json";
  const Rig rig = good_rig();
  const auto saved = save_rig(rig, path);
  ASSERT_TRUE(saved) << saved.error().what;
  const auto loaded = load_rig(path);
  ASSERT_TRUE(loaded) << loaded.error().what;
  EXPECT_EQ(loaded->left, rig.left);
  EXPECT_EQ(loaded->right, rig.right);
  EXPECT_EQ(loaded->right_from_left, rig.right_from_left);
  EXPECT_EQ(loaded->reprojection_rms_px, rig.reprojection_rms_px);
  EXPECT_EQ(loaded->errors, rig.errors);
  EXPECT_EQ(loaded->uncertainty, rig.uncertainty);
  EXPECT_EQ(loaded->metric, rig.metric);
  EXPECT_EQ(loaded->time_offset_s, rig.time_offset_s);
  EXPECT_EQ(loaded->left_name, rig.left_name);
  EXPECT_EQ(loaded->right_name, rig.right_name);
  EXPECT_EQ(loaded->date, rig.date);
  fs::remove(path);
}

// Files of the first release have none of what a calibration writes down about itself.
TEST(Rig, ReadsFilesWithoutARecord) {
  const auto loaded = parse_rig(R"({"schema": "duoptic.rig", "version": 1,
    "left": {"width": 640, "height": 480, "fx_px": 500, "fy_px": 500, "cx_px": 320, "cy_px": 240,
             "distortion": [0, 0, 0, 0, 0, 0, 0, 0]},
    "right": {"width": 640, "height": 480, "fx_px": 500, "fy_px": 500, "cx_px": 320, "cy_px": 240,
              "distortion": [0, 0, 0, 0, 0, 0, 0, 0]},
    "right_from_left": {"rotation": [1, 0, 0, 0, 1, 0, 0, 0, 1], "t_m": [-0.1, 0, 0]}, "reprojection_rms_px": 0.2})",
                                "old.json");
  ASSERT_TRUE(loaded) << loaded.error().what;
  EXPECT_EQ(loaded->errors, RigErrors{});
  EXPECT_FALSE(loaded->uncertainty);
  EXPECT_TRUE(loaded->metric);
  EXPECT_EQ(loaded->date, "");
}

TEST(Rig, ReadsEveryYamlSpelling) {
  expect_yaml_numbers(parse_rig(good_yaml(), "a"));
  expect_yaml_numbers(parse_rig(yaml("M1", "D1", "M2", "D2"), "a"));
  expect_yaml_numbers(
      parse_rig(yaml("camera_matrix_left", "dist_coeffs_left", "camera_matrix_right", "dist_coeffs_right"), "a"));
  expect_yaml_numbers(parse_rig(replaced(good_yaml(), "image_width: 640\nimage_height: 480", "image_size: [ 640, 480 ]"), "a"));
  expect_yaml_numbers(parse_rig(replaced(good_yaml(), "%YAML:1.0\n---\n", ""), "a"));
  expect_yaml_numbers(parse_rig(replaced(good_yaml(), "\n---\n", "\r\n---\r\n"), "a"));
}

TEST(Rig, ReadsOpencvJsonAndPlainLists) {
  expect_yaml_numbers(parse_rig(R"({"image_width": 640, "image_height": 480,
    "M1": {"type_id": "opencv-matrix", "rows": 3, "cols": 3, "dt": "d", "data": [500.0, 0, 320, 0, 501, 240, 0, 0, 1]},
    "D1": {"type_id": "opencv-matrix", "rows": 1, "cols": 5, "dt": "d", "data": [-0.1, 0.02, 0, 0, 0.003]},
    "M2": [[510, 0, 321], [0, 511, 241], [0, 0, 1]], "D2": [0.1, 0, 0, 5e-4],
    "R": [[1, 0, 0], [0, 1, 0], [0, 0, 1]], "T": [[-0.12], [0], [0.001]]})",
                                "a"));
}

TEST(Rig, RefusesWhatCannotBeARig) {
  EXPECT_TRUE(check_rig(good_rig(), "my_rig.json"));
  const auto with = [](auto change) {
    Rig rig = good_rig();
    change(rig);
    return rig;
  };
  const double nan = std::nan(""), inf = std::numeric_limits<double>::infinity();
  expect_refused(with([&](Rig& r) { r.left.fx_px = nan; }), "left camera matrix holds nan");
  expect_refused(with([&](Rig& r) { r.right.cy_px = inf; }), "right camera matrix holds inf");
  expect_refused(with([&](Rig& r) { r.left.distortion[7] = nan; }), "left distortion holds nan");
  expect_refused(with([&](Rig& r) { r.right_from_left.rotation(1, 1) = nan; }), "rotation holds nan");
  expect_refused(with([&](Rig& r) { r.right_from_left.t_m.z = inf; }), "translation holds inf");
  expect_refused(with([&](Rig& r) { r.reprojection_rms_px = -1; }), "reprojection_rms_px is -1");
  expect_refused(with([&](Rig& r) { r.errors.row_px = nan; }), "row_px is nan");
  expect_refused(with([&](Rig& r) { r.uncertainty->depth_m[2] = -1; }), "uncertainty is -1");
  expect_refused(with([&](Rig& r) { r.time_offset_s = inf; }), "time offset is inf");
  expect_refused(with([&](Rig& r) { r.left.fx_px = -556; }), "focal length -556 px");
  expect_refused(with([&](Rig& r) { r.left.fy_px = 100; }), "focal length 100 px");
  expect_refused(with([&](Rig& r) { r.right.fx_px = 7000; }), "focal length 7000 px");
  expect_refused(with([&](Rig& r) { r.right.cx_px = 1500; }), "principal point (1500");
  expect_refused(with([&](Rig& r) { r.left.size = {1, 480}; }), "1x480");
  expect_refused(with([&](Rig& r) { r.left.size = {640, 20000}; }), "640x20000");
  expect_refused(with([&](Rig& r) { r.right.size = {640, 512}; }), "640x512");
  expect_refused(with([&](Rig& r) { r.right_from_left.rotation(0, 0) = 0.9; }), "not orthonormal");
  expect_refused(with([&](Rig& r) { r.right_from_left.rotation = {{1, 0, 0, 0, 1, 0, 0, 0, -1}}; }), "determinant -1");
  expect_refused(with([&](Rig& r) { r.right_from_left.t_m = {-120, 0, 0}; }), "must be in metres");
  expect_refused(with([&](Rig& r) { r.right_from_left.t_m = {-0.001, 0, 0}; }), "at least 0.01 m");
  expect_refused(with([&](Rig& r) { r.right_from_left.t_m = {0.12, 0, 0}; }), "swapped");
  expect_refused(with([&](Rig& r) { r.right_from_left.t_m = {-0.05, 0.1, 0}; }), "side by side");
}

TEST(Rig, DoesNotSaveWhatItWouldRefuse) {
  const fs::path path = fs::temp_directory_path() / "duoptic_rig_test_bad.json";
  Rig rig = good_rig();
  rig.left.fx_px = 0;
  EXPECT_FALSE(save_rig(rig, path));
  EXPECT_FALSE(fs::exists(path));
}

TEST(Rig, RefusesBrokenText) {
  expect_text_refused("", "empty");
  expect_text_refused(" \n\t", "empty");
  expect_text_refused("hello", "no rig file of a known kind");
  expect_text_refused("<?xml version=\"1.0\"?>", "XML is broken or cut short");
  expect_text_refused("{\"schema\": \"duoptic.rig\", \"ver", "cut short");
  expect_text_refused("{\"schema\": \"other\", \"version\": 1}", "schema");
  expect_text_refused("{\"schema\": \"duoptic.rig\", \"version\": 2}", "version 1");
  expect_text_refused("{\"schema\": \"duoptic.rig\", \"version\": 1}", "'left/width' is missing");
  expect_text_refused("{\"schema\": \"duoptic.rig\", \"version\": 1, \"left\": {\"width\": \"a\"}}", "must be a whole number");
  expect_text_refused("{}", "no camera matrices");
  expect_text_refused("%YAML:1.0", "no rig file of a known kind");
  expect_text_refused("%YAML:1.0\n---\na: 1\n", "no camera matrices");
  const std::string yaml = good_yaml();
  expect_text_refused(yaml.substr(0, yaml.find("R: ") - 20), "cut short");
  expect_text_refused(replaced(yaml, "distCoeffs2", "x"), "'distCoeffs2' is missing");
  expect_text_refused(replaced(yaml, "cameraMatrix1", "x"), "'cameraMatrix1' is missing");
  expect_text_refused(replaced(yaml, "\nR:", "\nRR:"), "'R' is missing");
  expect_text_refused(replaced(yaml, "\nT:", "\nTT:"), "'T' is missing");
  expect_text_refused(replaced(yaml, "image_width", "x"), "'image_width' is missing");
  expect_text_refused(replaced(yaml, "image_height", "x"), "'image_height' is missing");
}

TEST(Rig, RefusesWrongNumbersInFiles) {
  const std::string yaml = good_yaml();
  expect_text_refused(replaced(yaml, "5.e-04 ", "5.e-04, 0., 0. "), "'distCoeffs2' has 6 numbers");
  expect_text_refused(replaced(yaml, "500., 0.,", "500., 1.,"), "[fx 0 cx; 0 fy cy; 0 0 1]");
  expect_text_refused(replaced(yaml, "500.", "abc"), "'cameraMatrix1' is not a matrix");
  expect_text_refused(replaced(yaml, "500.", ".NaN"), "left camera matrix holds nan");
  expect_text_refused(replaced(yaml, "500.", ".Nan"), "is not a matrix");  // the spelling of OpenCV itself
  expect_text_refused(replaced(yaml, "500.", ".Inf"), "left camera matrix holds inf");
  expect_text_refused(replaced(yaml, "640", "640.5"), "not a size");
  expect_text_refused(replaced(yaml, "640", "1e300"), "not a size");
  expect_text_refused(replaced(yaml, "-1.2e-01", "-120."), "must be in metres");
  expect_text_refused(replaced(yaml, "-1.2e-01", "1.2e-01"), "swapped");
}

// Parsers that call themselves for each level must not be led to the end of the stack.
TEST(Rig, RefusesDeepAndHugeText) {
  for (const std::string level : {"[", "{", "- ", "? ", "a: [", "&a [", "!t ", "-\n ", "{\"a\":"}) {
    std::string text = level[0] == '{' ? "" : "a: 1\nb:\n ";
    for (int i = 0; i < 100'000; ++i) text += level;
    EXPECT_FALSE(parse_rig(text, "deep"));
  }
  std::string stairs;
  for (int i = 0; i < 1300; ++i) stairs += std::string(static_cast<std::size_t>(i), ' ') + "a:\n";
  EXPECT_FALSE(parse_rig(stairs, "stairs"));
  expect_text_refused(good_yaml() + std::string(1 << 20, '\n'), "larger than 1 MiB");
}

TEST(Rig, NamesWhatCannotBeRead) {
  const auto missing = load_rig("/nonexistent/rig.json");
  ASSERT_FALSE(missing);
  EXPECT_EQ(missing.error().code, ErrorCode::kNotFound);
  EXPECT_NE(missing.error().what.find("/nonexistent/rig.json"), std::string::npos);
  const auto folder = load_rig("/tmp");
  ASSERT_FALSE(folder);
  EXPECT_NE(folder.error().what.find("/tmp"), std::string::npos);
}

}  // namespace
}  // namespace duo
