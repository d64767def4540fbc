// `duoptic view` as its users meet it: a virtual display, a mouse and keys, and pictures of its window.
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <signal.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <functional>
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

namespace duo {
namespace {

namespace fs = std::filesystem;
using test::bytes_of;
using test::Ended;
using test::put;

using test::kInput;
using test::kOutput;
constexpr Size kSize = {320, 240}, kPersonSize = {240, 180};  // of the room, and of the person, who is rendered on the way
// Twice three places on the wall of the synthetic room as far apart as an arm's, raw left pixels.
constexpr double kClicks_px[6][2] = {{160, 100}, {160, 77}, {160, 54}, {190, 100}, {190, 77}, {190, 54}};
// Where the camera's picture lies in the window as it opens: its corner, and its width.
constexpr double kCorner_px[2] = {16, 36}, kWidth_px = 528;
constexpr Rgb8 kBox = {60, 230, 80}, kBone = {235, 45, 40};

/// Where a pixel of a camera with pictures of this width is seen; axis 0 or 1.
double window_px(double picture_px, std::size_t axis, int width) {
  return kCorner_px[axis] + (picture_px + 0.5) * kWidth_px / width;
}

bool waited(const std::function<bool()>& until) {
  for (int i = 0; i < 600; ++i) {  // sanitizers render slowly
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
  static constexpr int kPairs = 6;

  static void SetUpTestSuite() {
    folder_ = std::make_unique<test::TempFolder>();
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
        "' && { Xvfb -displayfd 1 -screen 0 1500x900x24 -nolisten tcp -noreset >display.txt 2>/dev/null & echo $! "
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
      const Ended played = test::run_tool(at(""), "play --json " + name);
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

constexpr const char* kJoints[] = {"hand", "elbow", "shoulder"};
/// The same, of the arm that moves.
using Arm = std::array<SyntheticJoint, 3>;

Arm arm_of(SyntheticClip& person, int frame) {
  const std::string side = person.setup().arm == SyntheticArm::kLeft ? "left_" : "right_";
  Arm arm;
  for (const SyntheticJoint& joint : person.frame(frame).joints)
    for (std::size_t j = 0; j < 3; ++j)
      if (name_of(joint.id) == side + kJoints[j]) arm[j] = joint;
  return arm;
}

/// The live person goes through the first pairs of the clip, back, and again.
int clip_frame_of(std::int64_t number) {
  constexpr std::int64_t kPairs = 20, kRound = 2 * kPairs - 2;
  const std::int64_t turn = number % kRound;
  return static_cast<int>(std::min(turn, kRound - turn));
}

/// Of the camera.
bool same_picture(View<const Rgb8> a, View<const Rgb8> b) {
  for (int y = 40; y < 420; ++y)
    for (int x = 20; x < 540; ++x)
      if (a.at(y, x) != b.at(y, x)) return false;
  return true;
}

void expect_panels(View<const Rgb8> window) {
  EXPECT_GT(near(window, 280, 230, 264, kBox), 200);
  EXPECT_GT(near(window, 280, 230, 264, kBone), 100);
  EXPECT_GT(hues_in(window.crop(40, 570, {520, 380})), 5u);   // depth
  EXPECT_GT(hues_in(window.crop(560, 760, {320, 200})), 5u);  // hue
  for (const JointDef& joint : kRightArm.joints)
    EXPECT_GT(near(window, 550, 810, 180, shade_of(joint.id)), 100);  // body, and its legend
}

/// A box around each joint of the line, and two bones between them.
void expect_skeleton(View<const Rgb8> window, const nlohmann::json& line) {
  double uv[3][2];
  for (std::size_t j = 0; j < 3; ++j)
    for (std::size_t i = 0; i < 2; ++i)
      uv[j][i] =
          window_px(line["people"][0]["joints"][std::string("right_") + kJoints[j]]["uv_left_px"][i], i, kPersonSize.width);
  for (std::size_t j = 0; j < 3; ++j) {
    SCOPED_TRACE(kJoints[j]);
    EXPECT_GT(near(window, uv[j][0], uv[j][1], 4, kBox), 5);
    EXPECT_GT(near(window, uv[j][0], uv[j][1], 30, kBox), 60);
  }
  for (std::size_t j = 0; j < 2; ++j) {
    SCOPED_TRACE(kJoints[j]);
    EXPECT_GT(near(window, (uv[j][0] + uv[j + 1][0]) / 2, (uv[j][1] + uv[j + 1][1]) / 2, 4, kBone), 5);
  }
}

/// The largest distance of a joint from where the person has it, metres.
double farthest_m(const nlohmann::json& line, const nlohmann::json& header, SyntheticClip& person) {
  Mat3 rig_from_left;
  std::copy_n(header["rig_from_left"].begin(), 9, rig_from_left.m.begin());
  const Arm truth = arm_of(person, clip_frame_of(line["frame"]));
  double farthest = 0;
  for (std::size_t j = 0; j < 3; ++j) {
    const auto& joint = line["people"][0]["joints"][std::string("right_") + kJoints[j]];
    if (joint["state"] == "lost") return 1e3;
    const auto& p = joint["p_in_rig_m"];
    farthest = std::max(farthest, norm(Vec3{p[0], p[1], p[2]} - rig_from_left * truth[j].p_in_left_m));
  }
  return farthest;
}

/// A person, live, whose arm is clicked, moves, and is recorded.
TEST_F(Running, ThreeClicksTrackALivePerson) {
  auto person = SyntheticClip::open({.size = kPersonSize, .script = "wave"}, 2);
  ASSERT_TRUE(person);
  start("synthetic:wave:240x180:20 --paused --matcher pyramid -o lines.jsonl");
  const Arm first = arm_of(*person, 0);
  const char* prompts[] = {"right hand (1 of 3)", "right elbow (2 of 3)", "right shoulder (3 of 3)"};
  for (std::size_t j = 0; j < 3; ++j) {
    wait_for_title(prompts[j]);
    click((*first[j].uv_left_px)[0], (*first[j].uv_left_px)[1], kPersonSize.width);
  }
  wait_for_title("tracking");
  const Image<Rgb8> selected = screenshot();
  ASSERT_EQ(selected.size(), (Size{1440, 860}));
  expect_panels(selected);

  // It moves, is recorded, keeps up with its window's sizes, and is hidden and shown again.
  press("space");
  press("r");
  wait_for_title("tracking, recording");
  told("xdotool windowsize " + window_ + " 900 600");
  told("xdotool windowunmap " + window_ + " sleep 0.3 windowmap " + window_ + " sleep 0.3");
  EXPECT_EQ(screenshot().size(), (Size{900, 600}));
  press("r");
  ASSERT_TRUE(waited([&] { return told("xdotool getwindowname " + window_).find("recording") == std::string::npos; }));
  std::this_thread::sleep_for(std::chrono::seconds(1));  // the next recording has a name of its own all the same
  press("r");
  wait_for_title("tracking, recording");
  told("xdotool windowsize " + window_ + " 1440 860");
  // A busy machine leaves pictures out, and an arm that is inferred for a moment is drawn broken.
  Image<Rgb8> panels;
  EXPECT_TRUE(waited([&] { return near(panels = screenshot(), 280, 230, 264, kBone) > 100; }));
  expect_panels(panels);

  // The picture stands still while an arm is selected, and moves again when the selection is given up.
  told("xdotool mousemove --window " + window_ + " 1195 82 click 1");  // Select again
  wait_for_title(prompts[0]);
  click(120, 90, kPersonSize.width);
  wait_for_title(prompts[1]);
  const Image<Rgb8> held = screenshot();
  EXPECT_TRUE(same_picture(held, screenshot()));
  press("BackSpace");
  wait_for_title(prompts[0]);
  EXPECT_FALSE(same_picture(held, screenshot()));
  press("q");
  expect_end(0);
  EXPECT_EQ(bytes_of(at("view_err.txt")), "");

  const std::vector<nlohmann::json> lines = lines_of("lines.jsonl");
  constexpr std::size_t kSome = 3;
  ASSERT_GT(lines.size(), 1 + kSome);
  expect_skeleton(selected, lines[1]);
  EXPECT_LT(farthest_m(lines[1], lines[0], *person), 0.1) << lines[1];
  std::size_t good = 0;
  for (std::size_t i = 1; i <= kSome; ++i) good += farthest_m(lines[i * (lines.size() - 1) / kSome], lines[0], *person) < 0.15;
  EXPECT_GE(good, kSome - 1);
  expect_recordings(2);
}

/// One picture of each camera is a stream that has ended when its arms are selected.
TEST_F(Running, BothArmsOfAStillPicture) {
  start("left.png right.png --rig rig.json -o still.jsonl");
  wait_for_title("right hand (1 of 3)");
  told("xdotool mousemove --window " + window_ + " 1256 51 click 1");  // both
  for (int i = 0; i < 6; ++i) {
    wait_for_title("(" + std::to_string(i + 1) + " of 6)");
    click(kClicks_px[i][0], kClicks_px[i][1], kSize.width);
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
  ASSERT_EQ(frame["people"].size(), 2u) << line;
  EXPECT_EQ(frame["people"][1]["joints"].size(), 3u) << line;
}

TEST_F(Running, AnInterruptCompletesTheLines) {
  start("left.mp4 right.mp4 --rig rig.json --loop -o interrupted.jsonl");
  wait_for_title("Click");
  kill(std::atoi(bytes_of(at("view.txt")).c_str()), SIGTERM);
  expect_end(0);
  EXPECT_NE(bytes_of(at("interrupted.jsonl")).find("header"), std::string::npos);
}

/// A driver without OpenGL 3.0 for desktops, but with OpenGL ES 3.0.
TEST_F(ViewWindow, DrawsWithOpenGlEs) {
  const Ended ended = test::run_tool(at(""), "view left.mp4 right.mp4 --rig rig.json --screenshot es.png --after 1",
                                     environment() + "MESA_GL_VERSION_OVERRIDE=2.1 timeout 60");
  ASSERT_EQ(ended.exit, 0) << ended.err;
  const auto source = open_source(at("es.png"));
  Picture window;
  ASSERT_TRUE(source && (*source)->next(window));
  const View<const Rgb8> pixels = window.pixels;
  ASSERT_EQ(pixels.size(), (Size{1440, 860}));
  EXPECT_GT(hues_in(pixels.crop(40, 570, {520, 380})), 5u);   // depth
  EXPECT_GT(hues_in(pixels.crop(560, 760, {320, 200})), 5u);  // hue
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
  const std::string old_card = "MESA_GL_VERSION_OVERRIDE=2.1 MESA_GLES_VERSION_OVERRIDE=2.0 ";
  fails(clip, kInput, "there is no driver for OpenGL 3.0", display() + old_card);
  fails("left.mp4 right.mp4", kInput, "it does not bring a rig; give one with --rig", display());
  fails("none.mp4 right.mp4 --rig rig.json", kInput, "none.mp4", display());
  fails(clip + " -o none/lines.jsonl", kOutput, "make the folder first", display());
  fails(clip + " --screenshot none/window.png", kOutput, "make the folder first", display());
  fails(clip + " --screenshot window.png --after 99", kInput, "ends after 6 pairs", display());
}

}  // namespace
}  // namespace duo
