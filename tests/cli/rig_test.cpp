// `duoptic rig` from outside: verdicts, exit codes, files, and what it says of bad input.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "duoptic/rig.h"
#include "duoptic/sink.h"
#include "duoptic/synthetic.h"
#include "tool.h"

namespace duo {
namespace {

namespace fs = std::filesystem;
using test::Ended;
using test::kInput;
using test::kOutput;
using test::kUsage;

/// Pictures of the room with its rig, and the rig of before the right camera rolled by a degree. Rendered once for all tests.
class RigTool : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = std::make_unique<test::TempFolder>();
    const SyntheticPair room = render_synthetic({.size = {480, 360}}, 2);
    const double c = std::cos(M_PI / 180), s = std::sin(M_PI / 180);
    Rig nudged = room.rig;
    nudged.right_from_left = Rigid3{Mat3{{c, -s, 0, s, c, 0, 0, 0, 1}}, {}} * room.rig.right_from_left;
    ASSERT_TRUE(write_png(room.pair.left.pixels, at("left.png")) && write_png(room.pair.right.pixels, at("right.png")));
    ASSERT_TRUE(save_rig(room.rig, at("rig.json")) && save_rig(nudged, at("nudged.json")));
  }
  static void TearDownTestSuite() { folder_.reset(); }
  static fs::path at(const std::string& name) { return *folder_ / name; }

  static Ended run(const std::string& arguments, const std::string& command_name = "rig") {
    return test::run_tool(at(""), command_name + " " + arguments);
  }
  static void expect_failure(const std::string& arguments, int exit, const std::string& words,
                             const std::string& command_name = "rig") {
    SCOPED_TRACE(arguments);
    const Ended ended = run(arguments, command_name);
    EXPECT_EQ(ended.exit, exit);
    EXPECT_EQ(std::count(ended.err.begin(), ended.err.end(), '\n'), 1) << ended.err;
    EXPECT_NE(ended.err.find(words), std::string::npos) << ended.err;
    EXPECT_FALSE(fs::exists(at("out.json")));
  }

 private:
  inline static std::unique_ptr<test::TempFolder> folder_;
};

TEST_F(RigTool, ChecksNumbersAndPictures) {
  const Ended numbers = run("check rig.json");
  EXPECT_EQ(numbers.exit, 0) << numbers.err;
  EXPECT_NE(numbers.out.find("verdict  good"), std::string::npos) << numbers.out;
  const Ended good = run("check rig.json left.png right.png --json");
  EXPECT_EQ(good.exit, 0) << good.err;
  EXPECT_EQ(good.json()["verdict"], "good");
  EXPECT_LT(good.json()["scene"]["row_px"], 0.25);
  EXPECT_EQ(run("check rig.json left.png right.png --json --threads 1").out, good.out);
  const Ended bad = run("check nudged.json left.png right.png");
  EXPECT_EQ(bad.exit, kInput);
  EXPECT_NE(bad.out.find("verdict  recalibrate"), std::string::npos) << bad.out;
}

TEST_F(RigTool, RefinesWhatWasNudged) {
  const Ended only_told = run("refine nudged.json left.png right.png");
  EXPECT_EQ(only_told.exit, 0) << only_told.err;
  EXPECT_NE(only_told.out.find("before   recalibrate"), std::string::npos) << only_told.out;
  EXPECT_NE(only_told.out.find("after    good"), std::string::npos) << only_told.out;
  const Ended refined = run("refine nudged.json left.png right.png -o refined.json --json");
  EXPECT_EQ(refined.exit, 0) << refined.err;
  EXPECT_GT(refined.json()["before"]["row_px"], 0.75);
  EXPECT_LT(refined.json()["after"]["row_px"], 0.25);
  EXPECT_EQ(run("check refined.json left.png right.png").exit, 0);
}

TEST_F(RigTool, FindsARigInAScene) {
  const Ended metric =
      run("--from-scene left.png right.png --intrinsics nudged.json --baseline-m 0.2 -o found.json", "calibrate");
  EXPECT_EQ(metric.exit, 0) << metric.err;
  const auto found = load_rig(at("found.json"));
  ASSERT_TRUE(found) << found.error().what;
  EXPECT_TRUE(found->metric);
  EXPECT_NEAR(found->baseline_m(), 0.2, 1e-12);
  EXPECT_EQ(found->date.size(), 20u) << found->date;
  EXPECT_EQ(run("check found.json left.png right.png").exit, 0);

  const Ended guess = run("--from-scene left.png right.png -o guess.json", "calibrate");
  EXPECT_EQ(guess.exit, 0) << guess.err;
  EXPECT_NE(guess.err.find("not metric"), std::string::npos) << guess.err;
  const auto not_metric = load_rig(at("guess.json"));
  ASSERT_TRUE(not_metric);
  EXPECT_FALSE(not_metric->metric);
  expect_failure("export guess.json --to ros -o out.json", kInput, "not metric");
}

TEST_F(RigTool, ExportsAndImports) {
  for (const char* to :
       {"opencv -o there.yml", "opencv -o there.json", "ros -o there.yaml", "ros -o there", "kalibr -o there.yaml"}) {
    SCOPED_TRACE(to);
    EXPECT_EQ(run("export rig.json --to " + std::string(to)).exit, 0);
    const std::string file = std::string(to).substr(std::string(to).find("there"));
    const Ended back = run("import " + file + " -o back.json");
    EXPECT_EQ(back.exit, 0) << back.err;
    const auto rig = load_rig(at("back.json")), before = load_rig(at("rig.json"));
    ASSERT_TRUE(rig && before);
    EXPECT_LT(norm(rig->right_from_left.t_m - before->right_from_left.t_m), 1e-9);
  }
  EXPECT_EQ(run("import there/left.yaml there/right.yaml -o back.json").exit, 0);
}

TEST_F(RigTool, SaysInOneLineWhatIsWrong) {
  test::put(at("cut.yml"), "%YAML:1.0\n---\nM1: !!opencv-matrix\n   rows: 3\n   cols: 3\n   dt: d\n   data: [ 5.5");
  test::put(at("noise.yaml"), std::string("\x01\x02\x00\xff{[", 6));
  test::put(at("cam.yaml"), "cam0:\n  camera_model: pinhole\n");
  test::put(at("empty.json"), "");
  expect_failure("import cut.yml -o out.json", kInput, "cut short at line 7");
  expect_failure("import noise.yaml -o out.json", kInput, "noise.yaml");
  expect_failure("import cam.yaml -o out.json", kInput, "cam1 is missing");
  expect_failure("import empty.json -o out.json", kInput, "empty");
  expect_failure("import none.yaml -o out.json", kInput, "none.yaml");
  expect_failure("import left.png -o out.json", kInput, "left.png");
  expect_failure("import rig.json -o none/out.json", kOutput, "none");
  expect_failure("export rig.json --to matlab -o out.json", kUsage, "matlab");
  expect_failure("export rig.json --to kalibr -o out.json", kInput, ".yaml");
  expect_failure("check cut.yml", kInput, "cut short");
  expect_failure("check rig.json right.png left.png", kInput, "left and right are swapped");
  expect_failure("check rig.json left.png", kInput, "240x360");
  expect_failure("refine rig.json right.png left.png -o out.json", kInput, "left and right are swapped");
  expect_failure("refine rig.json left.png rig.json -o out.json", kInput, "rig.json");
  expect_failure("--from-scene right.png left.png --intrinsics rig.json -o out.json", kInput, "swapped", "calibrate");
  expect_failure("--from-scene left.png left.png --intrinsics rig.json -o out.json", kInput, "the same picture", "calibrate");
  expect_failure("--from-scene left.png right.png --baseline-m 127 -o out.json", kUsage, "baseline-m", "calibrate");
  expect_failure("--from-scene left.png right.png --intrinsics guess.json -o out.json", kInput, "guess", "calibrate");
  expect_failure("refine rig.json", kUsage, "LEFT");
  expect_failure("", kUsage, "subcommand");
}

}  // namespace
}  // namespace duo
