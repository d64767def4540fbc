// `duoptic board` and `duoptic calibrate` from outside: from a folder and from videos, its files, and one line for each input
// that gives no rig.
#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "duoptic/rig.h"
#include "duoptic/sink.h"
#include "sinks/clip/avi.h"
#include "tests/drawn_board.h"
#include "tool.h"

namespace duo {
namespace {

namespace fs = std::filesystem;
using test::Ended;
using test::kInput;
using test::kOutput;
using test::kUsage;

/// Mean over `width` pixels of a row: a board that moved while the shutter was open.
Image<Rgb8> smeared(View<const Rgb8> in, int width) {
  Image<Rgb8> out(in.size());
  for (int y = 0; y < in.height(); ++y)
    for (int x = 0; x + width <= in.width(); ++x) {
      int sum = 0;
      for (int i = 0; i < width; ++i) sum += in.at(y, x + i).g;
      const auto mean = static_cast<std::uint8_t>(sum / width);
      out.at(y, x) = {mean, mean, mean};
    }
  return out;
}

/// Pictures of a board, drawn once for all tests.
class CalibrateTool : public testing::Test {
 protected:
  static constexpr int kViews = 6;  // the fewest

  static void SetUpTestSuite() {
    folder_ = std::make_unique<test::TempFolder>();
    const Board board{.columns = 8, .rows = 6, .square_m = 0.03};
    const Rig rig = test::crooked_rig();
    const auto poses = test::spread_poses(board);
    for (int i = 0; i < kViews; ++i) pairs_.push_back(test::draw(board, rig, poses[i], i));
    write(
        "good", [](int i) { return View<const Rgb8>(pairs_[i].left.pixels); },
        [](int i) { return View<const Rgb8>(pairs_[i].right.pixels); });
  }
  static void TearDownTestSuite() {
    pairs_.clear();
    folder_.reset();
  }
  static fs::path at(const std::string& name) { return *folder_ / name; }

  /// A folder with both cameras' pictures.
  template <class Left, class Right>
  static void write(const std::string& name, Left left, Right right, int views = kViews) {
    fs::create_directory(at(name));
    for (int i = 0; i < views; ++i) {
      ASSERT_TRUE(write_png(left(i), at(name) / ("left" + std::to_string(i) + ".png")));
      ASSERT_TRUE(write_png(right(i), at(name) / ("right" + std::to_string(i) + ".png")));
    }
  }
  static View<const Rgb8> left(int i) { return pairs_[static_cast<std::size_t>(i)].left.pixels; }
  static View<const Rgb8> right(int i) { return pairs_[static_cast<std::size_t>(i)].right.pixels; }

  static Ended run(const std::string& arguments) { return test::run_tool(at(""), arguments); }
  static void expect_failure(const std::string& arguments, const std::string& words, int exit = kInput) {
    SCOPED_TRACE(arguments);
    const Ended ended = run("calibrate " + arguments + " --quiet -o out.json");
    EXPECT_EQ(ended.exit, exit);
    EXPECT_EQ(std::count(ended.err.begin(), ended.err.end(), '\n'), 1) << ended.err;
    EXPECT_NE(ended.err.find(words), std::string::npos) << ended.err;
    EXPECT_FALSE(fs::exists(at("out.json")) || fs::exists(at("out_report.html")));
  }

  inline static std::vector<Pair> pairs_;

 private:
  inline static std::unique_ptr<test::TempFolder> folder_;
};

TEST_F(CalibrateTool, MakesARigAndItsReport) {
  const Ended ended = run("calibrate good --board chessboard:7x5 --left-name L1 --json -o rig.json");
  constexpr double kSquare_mm = 30, kAssumed_mm = 29;  // as `duoptic board` prints them on A4
  ASSERT_EQ(ended.exit, 0) << ended.err;
  const auto json = nlohmann::json::parse(ended.out);
  EXPECT_EQ(json["pairs"], kViews);
  EXPECT_LT(json["errors"]["row_px"], 0.15);
  EXPECT_EQ(json["warnings"].dump().find("only 6 views") != std::string::npos, true) << json["warnings"];
  const auto rig = load_rig(at("rig.json"));
  ASSERT_TRUE(rig) << rig.error().what;
  EXPECT_EQ(rig->left_name, "L1");
  EXPECT_NEAR(rig->baseline_m() * kSquare_mm / kAssumed_mm, test::crooked_rig().baseline_m(), 3 * rig->uncertainty->baseline_m);
  EXPECT_NE(json["warnings"].dump().find("--square-mm was not given, and squares of 29 mm"), std::string::npos)
      << json["warnings"];
  const std::string report = test::bytes_of(at("rig_report.html"));
  for (const char* part : {"<!doctype html>", "only 6 views", "data:image/jpeg;base64,", "depth at 1.5 m", "</html>"})
    EXPECT_NE(report.find(part), std::string::npos) << part;
  EXPECT_EQ(report.find("nan"), std::string::npos);
}

/// A hand that holds the board still at one place after the other, each begun in motion.
TEST_F(CalibrateTool, TakesTheStillMomentsOfVideos) {
  constexpr int kFramesAPlace = 20, kMoving = 8;
  for (const bool is_left : {true, false}) {
    auto video = AviWriter::open(at(is_left ? "left.avi" : "right.avi"), left(0).size(), 30, 92);
    ASSERT_TRUE(video) << video.error().what;
    for (int i = 0; i < kViews * kFramesAPlace; ++i) {
      const View<const Rgb8> picture = is_left ? left(i / kFramesAPlace) : right(i / kFramesAPlace);
      Image<Rgb8> moved(picture.size());
      const int by = std::max(0, kMoving - i % kFramesAPlace);
      for (int y = 0; y < moved.height(); ++y)
        for (int x = 0; x < moved.width(); ++x) moved.at(y, x) = picture.at(y, std::max(0, x - 3 * by));
      ASSERT_TRUE(video->write(moved));
    }
    ASSERT_TRUE(video->finish());
  }
  const Ended ended = run("calibrate left.avi right.avi --board chessboard:7x5 --square-mm 30 --json -o video.json");
  ASSERT_EQ(ended.exit, 0) << ended.err;
  EXPECT_EQ(nlohmann::json::parse(ended.out)["pairs"], kViews * kFramesAPlace / 10);
  const auto rig = load_rig(at("video.json"));
  ASSERT_TRUE(rig) << rig.error().what;
  EXPECT_NEAR(rig->baseline_m(), test::crooked_rig().baseline_m(), 0.002);
  EXPECT_LT(rig->errors.row_px, 0.25);
}

TEST_F(CalibrateTool, SaysInOneLineWhatIsWrong) {
  const std::string board = " --board chessboard:7x5";
  write("swapped", right, left);
  expect_failure("swapped" + board, "swapped");
  std::vector<Image<Rgb8>> mirrored;
  for (int i = 0; i < kViews; ++i) {
    mirrored.emplace_back(right(i).size());
    for (int y = 0; y < mirrored.back().height(); ++y)
      std::reverse_copy(right(i).row(y), right(i).row(y) + right(i).width(), mirrored.back().row(y));
  }
  write("mirrored", left, [&](int i) { return View<const Rgb8>(mirrored[static_cast<std::size_t>(i)]); });
  expect_failure("mirrored" + board, "mirrored");
  std::vector<Image<Rgb8>> blurred;
  for (int i = 0; i < kViews; ++i) blurred.push_back(smeared(left(i), 9));
  write(
      "blurred", [&](int i) { return View<const Rgb8>(blurred[static_cast<std::size_t>(i)]); }, right);
  expect_failure("blurred" + board, "blurred");
  write("few", left, right, 3);
  expect_failure("few" + board, "too few views: 3 of 3");
  write(
      "one_pose", [](int) { return left(0); }, [](int) { return right(0); }, 6);
  expect_failure("one_pose" + board, "same pose");
  expect_failure("good --board charuco:7x5", "give --board chessboard:7x5");
  write(
      "mixed", left,
      [](int i) {
        return right(i).crop(0, 0, {480 - 2 * i, 360});
      },
      2);
  expect_failure("mixed" + board, "478x360");
  fs::create_directory(at("text"));
  test::put(at("text") / "left1.png", "no picture"), test::put(at("text") / "right1.png", "no picture");
  expect_failure("text", "left1.png");
  fs::create_directory(at("empty"));
  expect_failure("empty", "no pictures");
  expect_failure("none", "none");
  expect_failure("good/left0.png good/right0.png", "one pair of pictures is too few");
  expect_failure("good --board chess", "chessboard:9x6");
  expect_failure("good --square-mm 0" + board, "from 1 to 1000", kUsage);
  expect_failure("good --near 0", "near", kUsage);
  const Ended nowhere = run("calibrate good --quiet -o no/rig.json" + board);
  EXPECT_EQ(nowhere.exit, kOutput) << nowhere.err;
}

TEST_F(CalibrateTool, DrawsBoards) {
  for (const char* file : {"board.pdf", "board.svg", "board.png"}) {
    const Ended ended = run("board -o " + std::string(file));
    EXPECT_EQ(ended.exit, 0) << ended.err;
    EXPECT_NE(ended.out.find("--board chessboard:9x6 --square-mm 25"), std::string::npos) << ended.out;
    EXPECT_TRUE(fs::exists(at(file)));
  }
  for (const char* wrong : {"-o b.jpg", "-o b.pdf --square-mm 30", "-o b.pdf --paper a9", "-o b.pdf --board charuco:50x50"}) {
    const Ended ended = run("board " + std::string(wrong));
    EXPECT_EQ(ended.exit, kInput) << wrong;
    EXPECT_EQ(std::count(ended.err.begin(), ended.err.end(), '\n'), 1) << ended.err;
    EXPECT_FALSE(fs::exists(at("b.pdf")) || fs::exists(at("b.jpg")));
  }
}

}  // namespace
}  // namespace duo
