// Pairs that do not fit their rig, from outside: told by depth, track and record, and an end with --strict; and what depth
// writes.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <vector>

#include "core/coded_picture.h"
#include "duoptic/rig.h"
#include "duoptic/sink.h"
#include "duoptic/source.h"
#include "duoptic/synthetic.h"
#include "sinks/video_writer.h"
#include "tool.h"

namespace duo {
namespace {

namespace fs = std::filesystem;
using test::Ended;
using test::kInput;

Rig turned_rig(const Rig& rig, double tilt_deg, double pan_deg) {
  const double t = tilt_deg * M_PI / 180, p = pan_deg * M_PI / 180;
  const Mat3 tilt{{1, 0, 0, 0, std::cos(t), -std::sin(t), 0, std::sin(t), std::cos(t)}},
      pan{{std::cos(p), 0, std::sin(p), 0, 1, 0, -std::sin(p), 0, std::cos(p)}};
  Rig out = rig;
  out.right_from_left = Rigid3{pan * tilt, {}} * rig.right_from_left;
  return out;
}

/// Pictures and a video of two seconds of the room, its rig, the rig of before a camera was turned, and another rig.
class RigFitTool : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = std::make_unique<test::TempFolder>();
    const SyntheticSetup setup{.size = {480, 360}};
    const SyntheticPair room = render_synthetic(setup, 2);
    const Image<Rgb8>&left = room.pair.left.pixels, &right = room.pair.right.pixels;
    ASSERT_TRUE(write_png(left, at("left.png")) && write_png(right, at("right.png")));
    Image<Rgb8> both({960, 360}), mirrored({960, 360});
    for (int y = 0; y < 360; ++y)
      for (int x = 0; x < 480; ++x) {
        both.at(y, x) = right.at(y, x), both.at(y, 480 + x) = left.at(y, x);  // swapped
        mirrored.at(y, x) = left.at(y, 479 - x), mirrored.at(y, 480 + x) = right.at(y, 479 - x);
      }
    ASSERT_TRUE(write_png(both, at("swapped.png")) && write_png(mirrored, at("mirrored.png")));
    auto left_video = VideoWriter::open(at("left.mp4"), setup.size, 0.1),
         right_video = VideoWriter::open(at("right.mp4"), setup.size, 0.1);
    ASSERT_TRUE(left_video && right_video);
    for (int i = 0; i < 12; ++i) ASSERT_TRUE(left_video->write(left) && right_video->write(right));
    ASSERT_TRUE(left_video->finish() && right_video->finish());
    Rig guess = room.rig;
    guess.metric = false;
    ASSERT_TRUE(save_rig(room.rig, at("rig.json")) && save_rig(turned_rig(room.rig, 0, 0.6), at("pan.json")) &&
                save_rig(turned_rig(room.rig, 0.3, 0), at("tilt.json")) && save_rig(guess, at("guess.json")) &&
                save_rig(synthetic_rig({.size = setup.size, .seed = 5}), at("other.json")));
  }
  static void TearDownTestSuite() { folder_.reset(); }
  static fs::path at(const std::string& name) { return *folder_ / name; }
  static Ended run(const std::string& arguments) { return test::run_tool(at(""), arguments); }

  /// One line of warning, and all is written; with --strict the same line is the error.
  static void expect_told(const std::string& arguments, const std::string& words) {
    SCOPED_TRACE(arguments);
    const Ended told = run(arguments);
    EXPECT_EQ(told.exit, 0) << told.err;
    EXPECT_EQ(std::count(told.err.begin(), told.err.end(), '\n'), 1) << told.err;
    EXPECT_NE(told.err.find("warning: "), std::string::npos) << told.err;
    EXPECT_NE(told.err.find(words), std::string::npos) << told.err;
    const Ended strict = run(arguments + " --strict");
    EXPECT_EQ(strict.exit, kInput);
    EXPECT_EQ(std::count(strict.err.begin(), strict.err.end(), '\n'), 1) << strict.err;
    EXPECT_NE(strict.err.find(words), std::string::npos) << strict.err;
  }

 private:
  inline static std::unique_ptr<test::TempFolder> folder_;
};

TEST_F(RigFitTool, TheRightRigIsNotDoubted) {
  for (const char* arguments : {"depth left.png right.png --rig rig.json -o good --quiet --strict",
                                "depth left.mp4 right.mp4 --rig rig.json --every 6 -o good --quiet --strict",
                                "record left.mp4 right.mp4 --rig rig.json -o good.mkv --force --quiet --strict"}) {
    const Ended good = run(arguments);
    EXPECT_EQ(good.exit, 0) << good.err;
    EXPECT_EQ(good.err, "") << arguments;
  }
}

TEST_F(RigFitTool, ATurnedCameraAndAnotherRigAreTold) {
  expect_told("depth left.png right.png --rig pan.json -o turned --quiet", "disparities by ");
  expect_told("depth left.png right.png --rig tilt.json -o turned --quiet", "tilt -0.3");
  expect_told("depth left.mp4 right.mp4 --rig other.json --every 6 -o turned --quiet", "another rig's file");
  expect_told("record left.mp4 right.mp4 --rig tilt.json -o turned.mkv --force --quiet", "the rig does not fit");
}

TEST_F(RigFitTool, TrackTellsItAndIsLessSure) {
  const std::string clicks = " --select hand=240,150 --select elbow=240,115 --select shoulder=240,80 --quiet -o ";
  const auto sigmas = [&](const std::string& rig, const std::string& file) {
    const Ended ended = run("track left.mp4 right.mp4 --rig " + rig + clicks + file);
    EXPECT_EQ(ended.err.find("the rig does not fit") != std::string::npos, rig != "rig.json") << ended.err;
    std::vector<double> out;
    std::istringstream lines(test::bytes_of(at(file)));
    for (std::string line; std::getline(lines, line);)
      if (const auto json = nlohmann::json::parse(line, nullptr, false); json.contains("people") && !json["people"].empty())
        out.push_back(json["people"][0]["joints"]["right_shoulder"]["sigma_m"]);
    return out;
  };
  const auto good = sigmas("rig.json", "good.jsonl"), turned = sigmas("pan.json", "turned.jsonl");
  if (good.size() < 12 || turned.size() < 12) GTEST_SKIP() << "skipped: no arm in a room without a person";
  EXPECT_GT(turned[11], good[11] + 0.01);
  EXPECT_LT(good[11], good[3] + 0.01);
}

TEST_F(RigFitTool, KnownCausesAreNamed) {
  expect_told("depth right.png left.png --rig rig.json -o cause --quiet", "left and right are swapped: ");
  expect_told("depth swapped.png --rig rig.json -o cause --quiet", "left and right are swapped: ");
  expect_told("depth mirrored.png --rig rig.json -o cause --quiet", "both pictures are mirrored: ");
  expect_told("depth left.png left.png --keep-rows -o cause --quiet", "the same picture");
  expect_told("depth left.png right.png --rig guess.json -o cause --quiet", "not metric");
}

/// Of two cameras that look at a room in which a box moves, the right one hangs from the tenth picture on.
TEST_F(RigFitTool, ACameraThatHangsIsSaid) {
  const SyntheticPair room = render_synthetic({.size = {320, 240}}, 2);
  const auto with_box = [](const Image<Rgb8>& picture, int at_x) {
    Image<Rgb8> out = picture.clone();
    for (int y = 80; y < 160; ++y)
      for (int x = at_x; x < at_x + 40; ++x) out.at(y, x) = {static_cast<std::uint8_t>(4 * (x - at_x) + 40), 200, 30};
    return jpeg_of(out, 90);
  };
  std::string left, right, hung;
  for (int i = 0; i < 30; ++i) {
    left += with_box(room.pair.left.pixels, 20 + 6 * i);
    right += with_box(room.pair.right.pixels, 10 + 6 * i);
    hung += with_box(room.pair.right.pixels, 10 + 6 * std::min(i, 10));
  }
  for (const auto& [name, bytes] : {std::pair("l.mjpeg", &left), {"r.mjpeg", &right}, {"hung.mjpeg", &hung}})
    test::put(at(name), *bytes);
  const std::string words = "of the right pictures are the same as the one before";
  const Ended told = run("record l.mjpeg hung.mjpeg -o hung.mkv --force --quiet");
  EXPECT_EQ(told.exit, 0);
  EXPECT_NE(told.err.find(words), std::string::npos) << told.err;
  EXPECT_EQ(run("record l.mjpeg r.mjpeg -o good.mkv --force --quiet").err.find("the same as the one before"),
            std::string::npos);
}

TEST_F(RigFitTool, WhatFindsNothingSaysWhy) {
  const auto expect_line = [&](const std::string& arguments, const std::string& words, int exit = 0) {
    const Ended ended = run("depth " + arguments + " -o nothing --quiet");
    EXPECT_EQ(ended.exit, exit) << arguments;
    EXPECT_EQ(std::count(ended.err.begin(), ended.err.end(), '\n'), 1) << ended.err;
    EXPECT_NE(ended.err.find(words), std::string::npos) << ended.err;
  };
  Image<Rgb8> tiny({8, 8}), dark({160, 120});
  for (int i = 0; i < 64; ++i) tiny.at(i / 8, i % 8) = {static_cast<std::uint8_t>(i * 37 % 256), 90, 90};
  ASSERT_TRUE(write_png(tiny, at("tiny.png")) && write_png(dark, at("dark.png")));
  tiny.at(5, 5) = {255, 255, 255}, dark.at(5, 5) = {9, 9, 9};
  ASSERT_TRUE(write_png(tiny, at("tiny2.png")) && write_png(dark, at("dark2.png")));
  expect_line("tiny.png tiny2.png", "pictures of 8x8 pixels are too small");
  expect_line("dark.png dark2.png", "both pictures are dark");
  expect_line("left.png right.png --rig rig.json --max-disparity 4", "nearer than what is searched");
  expect_line("left.png right.png --rig rig.json --far 0.2", "lies farther than --far 0.2");
  expect_line("tiny.png tiny2.png --rig rig.json", "of another shape", kInput);
}

TEST_F(RigFitTool, NothingIsCalledMetresWhereNothingIsMetric) {
  const Ended ended = run("depth left.png right.png --rig guess.json -o guessed --json");
  EXPECT_EQ(ended.json()["camera"]["metric"], false);
  EXPECT_TRUE(ended.json()["camera"]["depth_unit_m"].is_null());
  EXPECT_EQ(test::bytes_of(at("guessed/cloud.ply")).find("metres"), std::string::npos);
}

TEST_F(RigFitTool, DepthSaysOfWhichPictureItIs) {
  const Ended ended = run("depth left.png right.png --rig rig.json -o outputs --json");
  ASSERT_EQ(ended.exit, 0) << ended.err;
  const nlohmann::json camera = nlohmann::json::parse(test::bytes_of(at("outputs/camera.json")), nullptr, false);
  EXPECT_EQ(ended.json()["camera"], camera);
  EXPECT_EQ(ended.json()["rig_fit"]["verdict"], "good");
  const auto depth = read_png16(at("outputs/depth.png"));
  ASSERT_TRUE(depth);
  EXPECT_EQ(camera["width"], depth->width());
  EXPECT_EQ(camera["height"], depth->height());
  const auto picture = open_source(at("outputs/left_rectified.png"));
  ASSERT_TRUE(picture);
  EXPECT_EQ((*picture)->size(), depth->size());
  // What other programs read as the camera of these pictures is the same.
  ASSERT_EQ(run("rig export rig.json --to ros-rectified -o infos").exit, 0);
  EXPECT_NE(test::bytes_of(at("infos/left.yaml")).find("image_width: " + std::to_string(depth->width())), std::string::npos);
}

TEST_F(RigFitTool, ARunTakesThePlaceOfAllFilesOfTheOneBefore) {
  ASSERT_EQ(run("depth left.png right.png --rig rig.json --confidence -o folder --quiet").exit, 0);
  EXPECT_TRUE(fs::exists(at("folder/depth.png")) && fs::exists(at("folder/confidence.png")));
  test::put(at("folder/mine.txt"), "kept");
  ASSERT_EQ(run("depth left.png right.png -o folder --quiet").exit, 0);
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(at("folder"))) names.push_back(entry.path().filename());
  std::sort(names.begin(), names.end());
  EXPECT_EQ(names, (std::vector<std::string>{"disparity.pfm", "disparity.png", "mine.txt"}));
}

TEST_F(RigFitTool, OnlyTheOutputsThatAreAskedFor) {
  ASSERT_EQ(run("depth left.png right.png --rig rig.json --outputs cloud,camera --far 3 --axes blender -o few --quiet").exit,
            0);
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(at("few"))) names.push_back(entry.path().filename());
  std::sort(names.begin(), names.end());
  EXPECT_EQ(names, (std::vector<std::string>{"camera.json", "cloud.ply"}));
  const Ended video = run("depth left.mp4 right.mp4 --rig rig.json --outputs depth-video --every 3 -o video --json");
  ASSERT_EQ(video.exit, 0) << video.err;
  EXPECT_EQ(video.json()["frames"], 4);
  const auto depth = open_source(at("video/depth.mkv"));
  ASSERT_TRUE(depth);
  EXPECT_NEAR((*depth)->frame_s(), 0.3, 0.01);  // one of three, of ten a second
  EXPECT_TRUE(fs::exists(at("video/depth.mkv")) && fs::exists(at("video/camera.json")));
  EXPECT_FALSE(fs::exists(at("video/frame_000000")));
  EXPECT_EQ(run("depth left.png right.png --outputs depth -o none").exit, kInput);
  EXPECT_EQ(run("depth left.png right.png --rig rig.json --outputs depth-video -o none").exit, kInput);
  EXPECT_EQ(run("depth left.png right.png --outputs nonsense -o none").exit, test::kUsage);
  EXPECT_FALSE(fs::exists(at("none")));
}

}  // namespace
}  // namespace duo
