// `duoptic detect`: what it finds, prints and writes, and what it says of networks that it cannot use.
#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

#include "tool.h"

namespace duo {
namespace {

using test::kInput;

class Detect : public ::testing::Test {
 protected:
  /// The rendered person, two frames.
  void make_clip() const { ASSERT_EQ(run("synth --quiet --frames 2 --size 320x240 -o clip").exit, 0); }
  test::Ended run(const std::string& arguments, const std::string& before = "") const {
    return test::run_tool(folder_ / "", arguments, before);
  }
  /// A folder with the project's networks, to be spoilt.
  void copy_models() const {
    std::filesystem::create_directory(folder_ / "models");
    for (const char* name : {"person_detector.net", "body_lite.net"})
      std::filesystem::copy_file(std::filesystem::path("models") / name, folder_ / "models" / name);
  }
  test::Ended run_with_models() const { return run("detect clip/left.avi --model lite --json", "DUOPTIC_MODELS=models"); }
  /// One line, exit 4, both on stderr and as JSON.
  static void expect_refused(const test::Ended& ended, const std::string& why) {
    EXPECT_EQ(ended.exit, kInput);
    EXPECT_NE(ended.err.find(why), std::string::npos) << ended.err;
    EXPECT_EQ(std::ranges::count(ended.err, '\n'), 1) << ended.err;
    EXPECT_EQ(ended.json()["error"]["exit"], kInput);
  }

  test::TempFolder folder_;
};

TEST_F(Detect, FindsTheRenderedPerson) {
  make_clip();
  const test::Ended ended = run("detect clip/left.avi --model lite --hands --json -o out");
  ASSERT_EQ(ended.exit, 0) << ended.err;
  const auto truth = nlohmann::json::parse(test::bytes_of(folder_ / "clip/truth.json"));
  std::istringstream lines(ended.out);
  std::string line;
  int frames = 0;
  for (; std::getline(lines, line); ++frames) {
    const auto found = nlohmann::json::parse(line);
    ASSERT_EQ(found["people"].size(), 1u) << line;
    const auto& person = found["people"][0];
    EXPECT_GT(person["score"], 0.5);
    EXPECT_EQ(person["box_px"].size(), 4u);
    EXPECT_EQ(person["points"].size(), 33u);
    for (const char* joint : {"left_shoulder", "right_shoulder"}) {
      const auto& uv = truth["frames"][frames]["joints"][joint]["uv_left"];
      if (uv.is_null()) continue;
      EXPECT_NEAR(person["points"][joint][0], uv[0], 25) << joint;
      EXPECT_NEAR(person["points"][joint][1], uv[1], 25) << joint;
    }
  }
  EXPECT_EQ(frames, 2);
  EXPECT_TRUE(std::filesystem::exists(folder_ / "out/frame_000001.png"));
  EXPECT_EQ(run("detect clip/left.avi --model lite --hands --json --threads 3").out, ended.out) << "threads change nothing";
}

TEST_F(Detect, NetworksThatCannotBeUsed) {
  make_clip();
  copy_models();
  ASSERT_EQ(run_with_models().exit, 0);
  const auto path = folder_ / "models/body_lite.net";
  std::filesystem::resize_file(path, 1 << 20);
  expect_refused(run_with_models(), "its hash is not what it says");
  std::ofstream(path) << "something else";
  expect_refused(run_with_models(), "it is no network of Duoptic's");
  std::filesystem::copy_file("models/hand_lite.net", path, std::filesystem::copy_options::overwrite_existing);
  expect_refused(run_with_models(), "it is 'hand_lite', not 'body_lite'");
  std::filesystem::remove(path);
  expect_refused(run_with_models(), "run tools/models/make body_lite");
}

TEST_F(Detect, NoPersonNoInput) {
  expect_refused(run("detect nothing.png --json"), "nothing.png");
  EXPECT_EQ(run("detect x.png --model large").exit, test::kUsage);
}

}  // namespace
}  // namespace duo
