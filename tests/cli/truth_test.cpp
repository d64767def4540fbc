// `duoptic truth`: patterns as pictures, and a scene of pictures that were taken of them.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>

#include "duoptic/sink.h"
#include "duoptic/source.h"
#include "duoptic/structured_light.h"
#include "tool.h"

namespace duo {
namespace {

namespace fs = std::filesystem;
using test::Ended;
using test::kInput;
using test::kUsage;

constexpr Size kView = {120, 90};
constexpr LightCode kCode{{224, 160}, 16};

/// A board of 40 x 30 px before a wall; on its right side the wall is in its shadow.
double disparity_px(int y, int x) { return x >= 50 && x < 90 && y >= 30 && y < 60 ? 20.5 : 12.25; }
bool in_shadow(int y, int x) { return x >= 90 && x < 96 && y >= 30 && y < 60; }

/// What the left picture's pixel, or a place between two, is lit by: pixels of the projector.
double lit_by(double x) { return 1.5 * x + 4; }

double texture(double x, int y) { return 40 + 30 * std::sin(0.9 * x + 0.31 * y) + 25 * std::sin(0.37 * x - 0.7 * y); }

/// Rectified pictures of this scene: left pixel (y, x) is what the right view has at x - d.
class Desk : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = std::make_unique<test::TempFolder>();
    make(at("shots"), kView);
    write(at("light_left.png"), [](int y, int x) { return 60 + texture(x, y); });
    write(at("light_right.png"), [](int y, int x) { return 60 + texture(left_of(y, x), y); });
  }
  static void TearDownTestSuite() { folder_.reset(); }
  static fs::path at(const std::string& name) { return *folder_ / name; }
  static Ended run(const std::string& arguments) { return test::run_tool(at(""), "truth " + arguments); }

  static bool on_board(int y, double x_left) { return y >= 30 && y < 60 && x_left >= 50 && x_left < 90; }
  /// The left view's column that a pixel of the right one shows.
  static double left_of(int y, int x) { return on_board(y, x + 20.5) ? x + 20.5 : x + 12.25; }
  /// The projector stands where the left camera is: the right one sees the board's shadow on the wall.
  static bool is_dark(int y, int x) { return !on_board(y, x + 20.5) && on_board(y, x + 12.25); }

  static void make(const fs::path& folder, Size size) {
    fs::create_directory(folder);
    const auto patterns = light_patterns(kCode);
    for (std::size_t i = 0; i < patterns.size(); ++i) {
      const auto pattern = draw_pattern(kCode, patterns[i]);
      const auto lit = [&](int y, double x_left) {
        if (in_shadow(y, static_cast<int>(x_left))) return 20.0;
        const double u = lit_by(x_left) - 0.5, v = 1.5 * y + 6;
        if (u < 0 || u > kCode.screen.width - 2) return 20.0;
        const int u0 = static_cast<int>(u), v0 = static_cast<int>(v);
        const double share = u - u0;
        return 20 + 0.6 * (pattern.at(v0, u0) * (1 - share) + pattern.at(v0, u0 + 1) * share);
      };
      write(
          folder / light_file_name(true, i), [&](int y, int x) { return lit(y, x); }, size);
      write(
          folder / light_file_name(false, i), [&](int y, int x) { return is_dark(y, x) ? 20.0 : lit(y, left_of(y, x)); }, size);
    }
    std::ofstream(folder / "patterns.json") << json_from_light_code(kCode);
  }

  template <class F>
  static void write(const fs::path& path, F value, Size size = kView) {
    Image<std::uint8_t> out(size);
    for (int y = 0; y < size.height; ++y)
      for (int x = 0; x < size.width; ++x)
        out.at(y, x) = static_cast<std::uint8_t>(std::clamp(std::lround(value(y, x)), 0L, 255L));
    ASSERT_TRUE(write_png(out, path));
  }

 private:
  inline static std::unique_ptr<test::TempFolder> folder_;
};

TEST_F(Desk, BecomesASceneThatEvalScores) {
  const Ended done = run("decode shots --light light_left.png --light light_right.png -o desk --json");
  ASSERT_EQ(done.exit, 0) << done.err;
  const auto report = done.json();
  EXPECT_EQ(report["width"], kView.width);
  EXPECT_EQ(report["exposures"], 1);
  EXPECT_NEAR(report["rows_px"], 0, 0.05);
  EXPECT_GT(report["left"]["known_percent"], 95) << done.out;
  EXPECT_EQ(report["left"]["saturated_percent"], 0);
  EXPECT_GT(report["left"]["unlit_percent"], 1);
  const auto truth = read_png16(at("desk/disp_left.png"));
  ASSERT_TRUE(truth.has_value());
  int known = 0, off = 0, in_the_dark = 0;
  for (int y = 0; y < kView.height; ++y)
    for (int x = 0; x < kView.width; ++x) {
      if (truth->at(y, x) == 0) continue;
      ++known;
      off += std::abs(truth->at(y, x) / 32.0 - disparity_px(y, x)) > 0.1;
      in_the_dark += in_shadow(y, x);
    }
  EXPECT_GT(known, 0.75 * kView.width * kView.height);
  EXPECT_LT(off, 0.01 * known);
  EXPECT_EQ(in_the_dark, 0);
  const Ended scored = test::run_tool(at(""), "eval middlebury desk --no-peers --json");
  ASSERT_EQ(scored.exit, 0) << scored.err;
  const auto scene = scored.json()["methods"][1]["scenes"][0];
  EXPECT_LT(scene["bad_filled_percent"][1][0], 5) << scored.out;
  EXPECT_GT(scene["coverage_percent"], 80);
  // Of a folder beside another the mean is told by itself.
  for (const char* name : {"room/one", "room/two"}) fs::create_directories(at("room")), fs::copy(at("desk"), at(name));
  const Ended several = test::run_tool(at(""), "eval middlebury room desk --no-peers --json");
  ASSERT_EQ(several.exit, 0) << several.err;
  const auto folders = several.json()["folders"];
  ASSERT_EQ(folders.size(), 1u) << several.out;
  EXPECT_EQ(folders[0]["folder"], "room");
  const auto means = [](const nlohmann::json& method) {
    return method["mean"]["bad_filled_percent"].get<std::vector<double>>();
  };
  const auto one = means(scored.json()["methods"][1]), two = means(folders[0]["methods"][1]);
  ASSERT_EQ(two.size(), one.size());
  for (std::size_t i = 0; i < one.size(); ++i) EXPECT_DOUBLE_EQ(two[i], one[i]);
  EXPECT_NE(test::run_tool(at(""), "eval middlebury room desk --no-peers").out.find("Mean over the scenes of room"),
            std::string::npos);
}

TEST_F(Desk, OneLineSaysWhatIsWrong) {
  const auto why = [&](const std::string& arguments, int exit = kInput) {
    const Ended ended = run(arguments + " -o none");
    EXPECT_EQ(ended.exit, exit) << arguments << ended.err;
    EXPECT_EQ(std::count(ended.err.begin(), ended.err.end(), '\n'), 1) << ended.err;
    EXPECT_FALSE(fs::exists(at("none")));
    return ended.err;
  };
  const auto copy = [&](const std::string& name) {
    fs::remove_all(at(name));
    fs::copy(at("shots"), at(name));
  };
  EXPECT_NE(why("decode nowhere").find("nowhere"), std::string::npos);
  copy("few");
  fs::remove(at("few") / "right_012.png");
  EXPECT_NE(why("decode few").find("right_012.png is missing, of pattern 12"), std::string::npos);
  EXPECT_NE(why("decode shots few").find("cannot decode few"), std::string::npos);
  copy("more");
  fs::copy(at("more/left_000.png"), at("more/left_037.png"));
  EXPECT_NE(why("decode more").find("left_037.png is there"), std::string::npos) << light_patterns(kCode).size();
  copy("sizes");
  write(at("sizes/left_005.png"), [](int, int) { return 5.0; }, {60, 40});
  EXPECT_NE(why("decode sizes").find("pattern 5 has 60x40"), std::string::npos);
  copy("damaged");
  fs::resize_file(at("damaged/left_007.png"), 40);
  EXPECT_NE(why("decode damaged").find("left_007.png"), std::string::npos);
  copy("unnamed");
  fs::remove(at("unnamed/patterns.json"));
  EXPECT_NE(why("decode unnamed").find("patterns.json"), std::string::npos);
  const Ended named = run("decode unnamed --patterns shots/patterns.json -o named --quiet");
  EXPECT_EQ(named.exit, 0);
  EXPECT_EQ(named.err.find("duoptic truth decode: warning: left.png is dark"), 0u) << named.err;
  // A projector that was off, or seen by one camera alone.
  copy("dark");
  for (std::size_t i = 1; i < light_patterns(kCode).size(); ++i)
    fs::copy_file(at("dark/right_000.png"), at("dark") / light_file_name(false, i), fs::copy_options::overwrite_existing);
  EXPECT_NE(why("decode dark").find("0 % of the right one's have a place"), std::string::npos);
  EXPECT_NE(why("decode shots --light light_left.png", kUsage).find("--light"), std::string::npos);
  EXPECT_NE(why("record light_left.png light_right.png").find("two cameras"), std::string::npos);
  EXPECT_NE(why("patterns --period 33").find("even"), std::string::npos);
}

TEST_F(Desk, PatternsAreWritten) {
  const Ended done = run("patterns --size 224x160 --period 16 --brightness 50 -o patterns --json");
  ASSERT_EQ(done.exit, 0) << done.err;
  const auto patterns = light_patterns(kCode);
  EXPECT_EQ(done.json()["patterns"], patterns.size());
  EXPECT_EQ(*load_light_code(at("patterns/patterns.json")), kCode);
  const auto picture = read_png16(at("patterns/pattern_004.png"));
  ASSERT_TRUE(picture.has_value());
  const auto want = draw_pattern(kCode, patterns[4], 128);
  for (int x = 0; x < kCode.screen.width; ++x) EXPECT_EQ(picture->at(9, x), want.at(9, x));
  EXPECT_FALSE(fs::exists(at("patterns/pattern_037.png")));
}

}  // namespace
}  // namespace duo
