// A window of `duoptic view` on a virtual display, with a mouse and keys.
#pragma once

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <signal.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <functional>
#include <memory>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>
#include <thread>

#include "duoptic/paint.h"
#include "duoptic/rig.h"
#include "duoptic/sink.h"
#include "duoptic/source.h"
#include "duoptic/synthetic.h"
#include "sinks/video_writer.h"
#include "tool.h"

namespace duo::window_test {

namespace fs = std::filesystem;
using test::bytes_of;
using test::Ended;
using test::kInput;
using test::kOutput;
using test::run_tool;
using test::TempFolder;

inline constexpr Size kSize = {320, 240},
                      kPersonSize = {240, 180};  // of the room, and of the person, who is rendered on the way
// Twice three places on the wall of the synthetic room as far apart as an arm's, raw left pixels.
inline constexpr double kClicks_px[6][2] = {{160, 100}, {160, 77}, {160, 54}, {190, 100}, {190, 77}, {190, 54}};
// Where the camera's picture lies in the window as it opens: its corner, and its width.
inline constexpr double kCorner_px[2] = {16, 36}, kWidth_px = 528;
inline constexpr Rgb8 kBox = {60, 230, 80}, kBone = {235, 45, 40}, kTick = {82, 168, 255};  // kTick: in a box of the controls

/// Where a pixel of a camera with pictures of this width is seen; axis 0 or 1.
inline double window_px(double picture_px, std::size_t axis, int width) {
  return kCorner_px[axis] + (picture_px + 0.5) * kWidth_px / width;
}

inline bool waited(const std::function<bool()>& until) {
  for (int i = 0; i < 600; ++i) {  // sanitizers render slowly
    if (until()) return true;
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
  }
  return false;
}

inline int near(View<const Rgb8> picture, double x_px, double y_px, int radius, Rgb8 color) {
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
inline std::size_t hues_in(View<const Rgb8> part) {
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
  static constexpr int kPairs = 6;

  static void SetUpTestSuite() {
    folder_ = std::make_unique<TempFolder>();
    const SyntheticSetup setup{.size = kSize};
    auto left = VideoWriter::open(at("left.mp4"), setup.size, 1.0 / 30);
    auto right = VideoWriter::open(at("right.mp4"), setup.size, 1.0 / 30);
    ASSERT_TRUE(left && right);
    const SyntheticPair raw = render_synthetic(setup, 2);
    for (int i = 0; i < kPairs; ++i) ASSERT_TRUE(left->write(raw.pair.left.pixels) && right->write(raw.pair.right.pixels));
    ASSERT_TRUE(left->finish() && right->finish());
    ASSERT_TRUE(write_png(raw.pair.left.pixels, at("left.png")) && write_png(raw.pair.right.pixels, at("right.png")));
    ASSERT_TRUE(save_rig(raw.rig, at("rig.json")));
    if (std::system("command -v Xvfb xdotool timeout >/dev/null") != 0) return;
    // -noreset: without it the server starts anew when its last window closes, and lets nobody in meanwhile.
    const std::string start =
        "cd '" + at("").string() +
        "' && { Xvfb -displayfd 1 -screen 0 1920x1080x24 -nolisten tcp -noreset >display.txt 2>/dev/null & echo $! "
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
  static std::string environment() {
    return display() + "ASAN_OPTIONS=detect_leaks=0 XDG_CACHE_HOME='" + at("cache").string() + "' ";
  }

  /// What a command prints.
  static std::string told(const std::string& command) {
    const std::string all = "cd '" + at("").string() + "' && " + display() + "timeout 5 " + command + " >told.txt 2>/dev/null";
    return std::system(all.c_str()) == 0 ? bytes_of(at("told.txt")) : "";
  }

 private:
  inline static std::unique_ptr<TempFolder> folder_;
};

/// A viewer that runs while the test does something to it.
class Running : public ViewWindow {
 protected:
  void start(const std::string& arguments) {
    for (const char* old : {"exit.txt", "view_out.txt", "view_err.txt"}) fs::remove(at(old));
    // MESA_DEBUG: the software driver says which calls of OpenGL are wrong.
    const std::string command = "cd '" + at("").string() + "' && { ( " + environment() + "MESA_DEBUG=1 '" DUO_TOOL "' view " +
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
  void click(double x_px, double y_px, int width) {
    told(fmt::format("xdotool mousemove --window {} {:.0f} {:.0f} click 1", window_, window_px(x_px, 0, width),
                     window_px(y_px, 1, width)));
  }
  void press(const std::string& key) { told("xdotool windowfocus " + window_ + " key " + key); }
  Image<Rgb8> screenshot() {
    const std::string name = fmt::format("duoptic_view_{:03}.png", ++screenshots_);
    fs::remove(at(name));  // of the window before
    press("F12");
    Picture picture;
    EXPECT_TRUE(waited([&] { return fs::exists(at(name)); })) << bytes_of(at("view_err.txt"));
    const auto source = open_source(at(name));
    EXPECT_TRUE(source && (*source)->next(picture));
    return std::move(picture.pixels);
  }
  static std::vector<nlohmann::json> lines_of(const std::string& name) {
    std::istringstream text(bytes_of(at(name)));
    std::vector<nlohmann::json> lines;
    for (std::string line; std::getline(text, line);) lines.push_back(nlohmann::json::parse(line, nullptr, false));
    EXPECT_TRUE(!lines.empty() && lines[0]["type"] == "header");
    return lines;
  }
  /// As many are in the folder, each whole.
  static void expect_recordings(int number) {
    for (const auto& entry : fs::directory_iterator(at(""))) {
      const std::string name = entry.path().filename();
      if (!name.starts_with("duoptic_2") || !name.ends_with(".mkv")) continue;
      --number;
      const Ended played = run_tool(at(""), "play --json " + name);
      EXPECT_EQ(played.exit, 0) << played.err;
      const auto report = played.json();
      EXPECT_GT(report["pairs"], 0) << played.out;
      EXPECT_TRUE(report["rig"].is_object()) << played.out;
      EXPECT_EQ(report["cut"], false) << played.out;
    }
    EXPECT_EQ(number, 0);
  }
  void expect_end(int exit) {
    ASSERT_TRUE(waited([] { return !bytes_of(at("exit.txt")).empty(); })) << "it does not end";
    EXPECT_EQ(std::atoi(bytes_of(at("exit.txt")).c_str()), exit) << bytes_of(at("view_err.txt"));
    EXPECT_EQ(bytes_of(at("view_out.txt")), "");
    EXPECT_EQ(bytes_of(at("view_err.txt")).find("Mesa"), std::string::npos) << bytes_of(at("view_err.txt"));
  }

  std::string window_;
  int screenshots_ = 0;
};

}  // namespace duo::window_test
