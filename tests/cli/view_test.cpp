// `duoptic view` as its users meet it: a virtual display, a mouse and keys, and pictures of its window.
#include <gtest/gtest.h>
#include <signal.h>

#include <algorithm>
#include <chrono>
#include <functional>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>
#include <thread>

#include "duoptic/rig.h"
#include "duoptic/sink.h"
#include "duoptic/source.h"
#include "duoptic/synthetic.h"
#include "sinks/video_writer.h"
#include "tool.h"

namespace duo {
namespace {

namespace fs = std::filesystem;
using test::bytes_of;
using test::Ended;
using test::put;

constexpr int kInput = 4, kOutput = 5;
constexpr int kPairs = 6;
// Twice three places on the wall of the synthetic room as far apart as an arm's, raw left pixels.
constexpr double kClicks_px[6][2] = {{160, 100}, {160, 77}, {160, 54}, {190, 100}, {190, 77}, {190, 54}};
// Where the camera's picture lies in the window as it opens: its corner, and its scale.
constexpr double kCorner_px[2] = {16, 36}, kScale = 528.0 / 320;
constexpr Rgb8 kBox = {60, 230, 80}, kBone = {235, 45, 40};

double window_px(double picture_px, double corner_px) { return corner_px + (picture_px + 0.5) * kScale; }

bool waited(const std::function<bool()>& until) {
  for (int i = 0; i < 200; ++i) {
    if (until()) return true;
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
  }
  return false;
}

int near(View<const Rgb8> picture, double x_px, double y_px, int radius, Rgb8 color) {
  int found = 0;
  for (int y = std::max(0, static_cast<int>(y_px) - radius);
       y <= std::min(picture.height() - 1, static_cast<int>(y_px) + radius); ++y)
    for (int x = std::max(0, static_cast<int>(x_px) - radius);
         x <= std::min(picture.width() - 1, static_cast<int>(x_px) + radius); ++x) {
      const Rgb8 c = picture.at(y, x);
      found += std::abs(c.r - color.r) < 12 && std::abs(c.g - color.g) < 12 && std::abs(c.b - color.b) < 12;
    }
  return found;
}

/// How many colours with a hue a part of the window has, coarsely.
std::size_t hues_in(View<const Rgb8> part) {
  std::set<int> found;
  for (int y = 0; y < part.height(); ++y)
    for (int x = 0; x < part.width(); ++x) {
      const Rgb8 c = part.at(y, x);
      if (std::max({c.r, c.g, c.b}) - std::min({c.r, c.g, c.b}) > 100)
        found.insert((c.r >> 6) << 4 | (c.g >> 6) << 2 | c.b >> 6);
    }
  return found.size();
}

/// A short clip of the synthetic room, and a display to look at it on. Made once for all tests.
class ViewWindow : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = std::make_unique<test::TempFolder>();
    const SyntheticSetup setup{.size = {320, 240}};
    auto left = VideoWriter::open(at("left.mp4"), setup.size, 1.0 / 30);
    auto right = VideoWriter::open(at("right.mp4"), setup.size, 1.0 / 30);
    ASSERT_TRUE(left && right);
    const SyntheticPair raw = render_synthetic(setup, 2);
    for (int i = 0; i < kPairs; ++i) ASSERT_TRUE(left->write(raw.pair.left.pixels) && right->write(raw.pair.right.pixels));
    ASSERT_TRUE(left->finish() && right->finish());
    ASSERT_TRUE(write_png(raw.pair.left.pixels, at("left.png")) && write_png(raw.pair.right.pixels, at("right.png")));
    ASSERT_TRUE(save_rig(raw.rig, at("rig.json")));
    if (std::system("command -v Xvfb xdotool timeout >/dev/null") != 0) return;
    const std::string start = "cd '" + at("").string() +
                              "' && { Xvfb -displayfd 1 -screen 0 1500x900x24 -nolisten tcp >display.txt 2>/dev/null & echo $! "
                              ">xvfb.txt; }";
    ASSERT_EQ(std::system(start.c_str()), 0);
    ASSERT_TRUE(waited([] { return !bytes_of(at("display.txt")).empty(); }));
  }
  static void TearDownTestSuite() {
    if (const int server = std::atoi(bytes_of(at("xvfb.txt")).c_str()); server > 0) kill(server, SIGTERM);
    folder_.reset();
  }
  void SetUp() override {
    if (!fs::exists(at("display.txt"))) GTEST_SKIP() << "skipped: no Xvfb or no xdotool";
  }

  static fs::path at(const std::string& name) { return *folder_ / name; }
  static std::string display() { return "DISPLAY=:" + std::to_string(std::atoi(bytes_of(at("display.txt")).c_str())) + " "; }
  /// Drivers are unloaded before leaks are looked for, so that theirs cannot be told from ours.
  static std::string environment() { return display() + "ASAN_OPTIONS=detect_leaks=0 "; }

  /// What a command prints.
  static std::string told(const std::string& command) {
    const std::string all = "cd '" + at("").string() + "' && " + display() + "timeout 5 " + command + " >told.txt 2>/dev/null";
    return std::system(all.c_str()) == 0 ? bytes_of(at("told.txt")) : "";
  }

 private:
  inline static std::unique_ptr<test::TempFolder> folder_;
};

/// A viewer that runs while the test does something to it.
class Running : public ViewWindow {
 protected:
  void start(const std::string& arguments) {
    for (const char* old : {"exit.txt", "view_out.txt", "view_err.txt"}) fs::remove(at(old));
    const std::string command = "cd '" + at("").string() + "' && { ( " + environment() +
                                "VK_INSTANCE_LAYERS=VK_LAYER_KHRONOS_validation '" DUO_TOOL "' view --rig rig.json " +
                                arguments +
                                " >view_out.txt 2>view_err.txt & echo $! >view.txt; wait $!; echo $? >exit.txt ) & }";
    ASSERT_EQ(std::system(command.c_str()), 0);
    ASSERT_TRUE(waited([this] {
      window_ = told("xdotool search --onlyvisible --name 'duoptic view'");
      while (!window_.empty() && std::isspace(window_.back()) != 0) window_.pop_back();
      return !window_.empty();
    })) << bytes_of(at("view_err.txt"));
  }
  void TearDown() override {
    if (!fs::exists(at("exit.txt")))
      if (const int viewer = std::atoi(bytes_of(at("view.txt")).c_str()); viewer > 0) kill(viewer, SIGKILL);
  }
  void wait_for_title(const std::string& words) {
    std::string title;
    ASSERT_TRUE(waited([&] { return (title = told("xdotool getwindowname " + window_)).find(words) != std::string::npos; }))
        << "no title '" << words << "' but " << title << bytes_of(at("view_err.txt"));
  }
  void click(int joint) {
    const auto x = static_cast<int>(window_px(kClicks_px[joint][0], kCorner_px[0]));
    const auto y = static_cast<int>(window_px(kClicks_px[joint][1], kCorner_px[1]));
    told("xdotool mousemove --window " + window_ + " " + std::to_string(x) + " " + std::to_string(y) + " click 1");
    clicked_[joint][0] = (x - kCorner_px[0]) / kScale - 0.5;
    clicked_[joint][1] = (y - kCorner_px[1]) / kScale - 0.5;
  }
  void press(const std::string& key) { told("xdotool windowfocus " + window_ + " key " + key); }
  Image<Rgb8> screenshot(const std::string& name) {
    press("F12");
    Picture picture;
    EXPECT_TRUE(waited([&] { return fs::exists(at(name)); })) << bytes_of(at("view_err.txt"));
    const auto source = open_source(at(name));
    EXPECT_TRUE(source && (*source)->next(picture));
    return std::move(picture.pixels);
  }
  void expect_end(int exit) {
    ASSERT_TRUE(waited([] { return !bytes_of(at("exit.txt")).empty(); })) << "it does not end";
    EXPECT_EQ(std::atoi(bytes_of(at("exit.txt")).c_str()), exit) << bytes_of(at("view_err.txt"));
    EXPECT_EQ(bytes_of(at("view_out.txt")), "");  // the validation layer would speak here
  }

  std::string window_;
  double clicked_[6][2] = {};
};

TEST_F(Running, ThreeClicksStartTracking) {
  start("left.mp4 right.mp4 --paused --loop -o lines.jsonl");
  const char* prompts[] = {"right hand (1 of 3)", "right elbow (2 of 3)", "right shoulder (3 of 3)"};
  for (int joint = 0; joint < 3; ++joint) {
    wait_for_title(prompts[joint]);
    click(joint);
  }
  wait_for_title("tracking");
  const Image<Rgb8> window = screenshot("duoptic_view_001.png");
  ASSERT_EQ(window.size(), (Size{1440, 860}));

  // What track makes of the same clicks.
  std::string arguments = "track left.mp4 right.mp4 --rig rig.json";
  for (int j = 0; j < 3; ++j)
    arguments += " --select " + std::string(kJointNames[static_cast<std::size_t>(j)]) + "=" + std::to_string(clicked_[j][0]) +
                 "," + std::to_string(clicked_[j][1]);
  const Ended track = test::run_tool(at(""), arguments);
  ASSERT_EQ(track.exit, 0) << track.err;
  std::istringstream tracked(track.out);
  std::string line;
  std::getline(tracked, line);
  std::getline(tracked, line);
  const auto expected = nlohmann::json::parse(line)["joints"];
  double uv[3][2];
  for (std::size_t j = 0; j < 3; ++j)
    for (std::size_t i = 0; i < 2; ++i)
      uv[j][i] = window_px(expected[std::string(kJointNames[j])]["uv_left_px"][i], kCorner_px[i]);
  for (std::size_t j = 0; j < 3; ++j) {
    SCOPED_TRACE(kJointNames[j]);
    EXPECT_GT(near(window, uv[j][0], uv[j][1], 4, kBox), 5);
    EXPECT_GT(near(window, uv[j][0], uv[j][1], 30, kBox), 60);
  }
  for (std::size_t j = 0; j < 2; ++j) {
    SCOPED_TRACE(kJointNames[j]);
    EXPECT_GT(near(window, (uv[j][0] + uv[j + 1][0]) / 2, (uv[j][1] + uv[j + 1][1]) / 2, 4, kBone), 5);
  }
  EXPECT_GT(hues_in(window.view().crop(40, 570, {520, 380})), 5u);                           // depth
  EXPECT_GT(hues_in(window.view().crop(560, 760, {320, 200})), 5u);                          // hue
  for (const Rgb8 shade : kJointShades) EXPECT_GT(near(window, 550, 810, 180, shade), 100);  // arm region, and its legend

  // It plays, keeps up with its window's sizes, and is hidden and shown again.
  press("space");
  told("xdotool windowsize " + window_ + " 900 600");
  told("xdotool windowunmap " + window_ + " sleep 0.3 windowmap " + window_ + " sleep 0.3");
  EXPECT_EQ(screenshot("duoptic_view_002.png").size(), (Size{900, 600}));
  press("q");
  expect_end(0);
  EXPECT_EQ(bytes_of(at("view_err.txt")), "");

  std::istringstream lines(bytes_of(at("lines.jsonl")));
  std::getline(lines, line);
  EXPECT_EQ(nlohmann::json::parse(line)["type"], "header");
  int frames = 0;
  for (; std::getline(lines, line); ++frames) {
    const auto frame = nlohmann::json::parse(line);
    for (const std::string_view joint : kJointNames) EXPECT_TRUE(frame["joints"].contains(joint)) << line;
    if (frames > 0) continue;
    EXPECT_EQ(frame["frame"], 0);
    for (const std::string_view joint : kJointNames)
      for (std::size_t i = 0; i < 3; ++i)
        EXPECT_NEAR(frame["joints"][std::string(joint)]["p_in_rig_m"][i], expected[std::string(joint)]["p_in_rig_m"][i], 0.002)
            << line;
  }
  EXPECT_GT(frames, 1);
}

/// One picture of each camera is a stream that has ended when its arms are selected.
TEST_F(Running, BothArmsOfAStillPicture) {
  start("left.png right.png -o still.jsonl");
  wait_for_title("right hand (1 of 3)");
  told("xdotool mousemove --window " + window_ + " 1256 51 click 1");  // both
  for (int i = 0; i < 6; ++i) {
    wait_for_title("(" + std::to_string(i + 1) + " of 6)");
    click(i);
  }
  wait_for_title("tracking");
  press("q");
  expect_end(0);
  std::istringstream lines(bytes_of(at("still.jsonl")));
  std::string line;
  std::getline(lines, line);
  std::getline(lines, line);
  const auto frame = nlohmann::json::parse(line, nullptr, false);
  EXPECT_EQ(frame["frame"], 0) << line;
  EXPECT_EQ(frame["joints"].size(), 3u) << line;
  EXPECT_EQ(frame["joints2"].size(), 3u) << line;
}

TEST_F(Running, AnInterruptCompletesTheLines) {
  start("left.mp4 right.mp4 --loop -o interrupted.jsonl");
  wait_for_title("Click");
  kill(std::atoi(bytes_of(at("view.txt")).c_str()), SIGTERM);
  expect_end(0);
  EXPECT_NE(bytes_of(at("interrupted.jsonl")).find("header"), std::string::npos);
}

TEST_F(ViewWindow, SaysWhatIsWrong) {
  const auto fails = [](const std::string& arguments, int exit, const std::string& words, const std::string& before) {
    SCOPED_TRACE(arguments + words);
    const Ended ended = test::run_tool(at(""), "view " + arguments, before + "ASAN_OPTIONS=detect_leaks=0 timeout 20");
    EXPECT_EQ(ended.exit, exit) << ended.err;
    EXPECT_EQ(std::count(ended.err.begin(), ended.err.end(), '\n'), 1) << ended.err;
    EXPECT_NE(ended.err.find(words), std::string::npos) << ended.err;
    EXPECT_EQ(ended.out, "");
  };
  const std::string clip = "left.mp4 right.mp4 --rig rig.json";
  fails(clip, kInput, "there is no display", "env -u DISPLAY -u WAYLAND_DISPLAY ");
  fails(clip, kInput, "Vulkan has no driver here", display() + "VK_ICD_FILENAMES=/nowhere VK_DRIVER_FILES=/nowhere ");
  fails("left.mp4 right.mp4", kInput, "it does not bring a rig; give one with --rig", display());
  fails("none.mp4 right.mp4 --rig rig.json", kInput, "none.mp4", display());
  fails(clip + " -o none/lines.jsonl", kOutput, "make the folder first", display());
  fails(clip + " --screenshot none/window.png", kOutput, "make the folder first", display());
  fails(clip + " --screenshot window.png --after 99", kInput, "ends after 6 pairs", display());
}

}  // namespace
}  // namespace duo
