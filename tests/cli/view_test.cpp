// `duoptic view` as its users meet it: clicks and keys, and pictures of its window.
#include "view_window.h"

#include <array>
#include <cmath>

namespace duo::window_test {
namespace {

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
  start("synthetic:wave:240x180:20 --tracker arm --paused --matcher pyramid -o lines.jsonl");
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
  ASSERT_GT(lines.size(), 4u);
  expect_skeleton(selected, lines[1]);
  EXPECT_LT(farthest_m(lines[1], lines[0], *person), 0.1) << lines[1];
  // Of all frames: a busy machine leaves out pictures, in which the arm moves too far, and at 240x180 that costs some frames.
  const auto near = std::count_if(lines.begin() + 1, lines.end(),
                                  [&](const nlohmann::json& line) { return farthest_m(line, lines[0], *person) < 0.15; });
  EXPECT_GT(2 * near, static_cast<std::ptrdiff_t>(lines.size()));
  expect_recordings(2);
}

/// Without a source the window asks; what was shown before is on its list.
TEST_F(Running, AloneItAsksAndRemembers) {
  start("left.png right.png --rig rig.json");
  wait_for_title("duoptic view");
  press("q");
  expect_end(0);
  start("");
  wait_for_title("choose a source");
  told("xdotool windowsize " + window_ + " 640 480");
  press("2");  // the first is the rendered person; here are no cameras
  ASSERT_TRUE(waited([&] { return told("xdotool getwindowname " + window_).find("choose") == std::string::npos; }));
  press("F1");
  const auto saved = [this] {
    press("s");  // there are points from the first frame on
    return fs::exists(at("duoptic_view_001.ply"));
  };
  ASSERT_TRUE(waited(saved));
  EXPECT_EQ(bytes_of(at("duoptic_view_001.ply")).rfind("ply\n", 0), 0u);
  EXPECT_EQ(screenshot().size(), (Size{640, 480}));
  press("q");
  expect_end(0);
}

/// In any order; a rig that comes alone waits for pictures.
TEST_F(Running, AloneItTakesDroppedFiles) {
  const auto drop = [this](const std::string& files) {
    return std::system((display() + "timeout 10 '" DUO_DROP_FILES "' " + window_ + files).c_str()) == 0;
  };
  const auto file = [](const char* name) { return " '" + at(name).string() + "'"; };
  start("");
  wait_for_title("choose a source");
  EXPECT_TRUE(drop(file("rig.json")));
  EXPECT_TRUE(drop(file("right.mp4") + file("left.mp4")));
  ASSERT_TRUE(waited([&] { return told("xdotool getwindowname " + window_).find("choose") == std::string::npos; }));
  press("q");
  expect_end(0);
  EXPECT_TRUE(
      bytes_of(at("cache/duoptic/recent"))
          .starts_with(at("left.mp4").string() + "\t" + at("right.mp4").string() + "\t" + at("rig.json").string() + "\n"))
      << bytes_of(at("cache/duoptic/recent"));
}

/// One picture of each camera is a stream that has ended when its arms are selected.
TEST_F(Running, BothArmsOfAStillPicture) {
  start("left.png right.png --rig rig.json --tracker arm -o still.jsonl");
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

TEST_F(Running, ABoxOfOutputsWritesItsFile) {
  constexpr int kBox_px[2] = {1134, 331};  // of CSV, where Outputs are unfolded
  start("left.mp4 right.mp4 --rig rig.json --tracker arm --paused");
  wait_for_title("right hand (1 of 3)");
  told("xdotool mousemove --window " + window_ + " 1273 237 click 1");  // Outputs
  EXPECT_EQ(near(screenshot(), kBox_px[0], kBox_px[1], 9, kTick), 0);
  told(fmt::format("xdotool mousemove --window {} {} {} click 1", window_, kBox_px[0], kBox_px[1]));
  ASSERT_TRUE(waited([&] { return near(screenshot(), kBox_px[0], kBox_px[1], 9, kTick) > 5; }));
  for (int i = 0; i < 3; ++i) {
    wait_for_title("(" + std::to_string(i + 1) + " of 3)");
    click(kClicks_px[i][0], kClicks_px[i][1], kSize.width);
  }
  wait_for_title("tracking");
  press("q");
  expect_end(0);
  std::vector<std::string> found;
  for (const auto& entry : fs::directory_iterator(at("")))
    if (entry.path().extension() == ".csv") found.push_back(bytes_of(entry.path()));
  ASSERT_EQ(found.size(), 1u);
  EXPECT_TRUE(found[0].starts_with("frame,t_s,person,joint,x_m,y_m,z_m,state,sigma_m,confidence\n0,")) << found[0];
  EXPECT_EQ(std::count(found[0].begin(), found[0].end(), '\n'), 4) << found[0];
  for (const char* joint : kJoints) EXPECT_NE(found[0].find(fmt::format("right_{},", joint)), std::string::npos) << found[0];
}

/// Frame steps both ways, a panel alone and all again, and a region that is measured: by what the window shows.
TEST_F(Running, StepsEnlargesAndMeasures) {
  constexpr Rgb8 kLine = {232, 234, 238};
  const auto caption = [](const Image<Rgb8>& window) {  // "frame 2   0.07 s"
    Image<Rgb8> out({170, 22});
    for (int y = 0; y < out.height(); ++y) std::copy_n(window.row(12 + y) + 370, out.width(), out.row(y));
    return out;
  };
  const auto same = [](View<const Rgb8> a, View<const Rgb8> b) {
    for (int y = 0; y < a.height(); ++y)
      if (!std::equal(a.row(y), a.row(y) + a.width(), b.row(y))) return false;
    return true;
  };
  start("left.mp4 right.mp4 --rig rig.json --model lite --paused");
  Image<Rgb8> first, second, third;
  ASSERT_TRUE(waited([&] { return hues_in((first = screenshot()).view().crop(40, 570, {520, 380})) > 5; }));
  const auto changed = [&](const Image<Rgb8>& from, Image<Rgb8>& to) {
    return waited([&] { return !same(caption(from), caption(to = screenshot())); });
  };
  press("Right");
  ASSERT_TRUE(changed(first, second));
  press("Right");
  ASSERT_TRUE(changed(second, third));
  press("Left");
  EXPECT_TRUE(waited([&] { return same(caption(second), caption(screenshot())); }));

  const auto rectangle = [&](const Image<Rgb8>& window) {
    return near(window, 700, 120, 1, kLine) + near(window, 800, 150, 1, kLine);
  };
  EXPECT_EQ(rectangle(second), 0);
  told(fmt::format(
      "xdotool mousemove --window {0} 640 120 mousedown 1 sleep 0.3 mousemove --window {0} 800 260 sleep 0.3 mouseup 1",
      window_));
  EXPECT_TRUE(waited([&] { return rectangle(screenshot()) > 2; }));

  // Alone, depth covers what was the lower row.
  const auto alone = [&] {
    told("xdotool mousemove --window " + window_ + " 700 200 click --repeat 2 --delay 150 1 sleep 0.3");
    return hues_in(screenshot().view().crop(500, 20, {300, 200})) > 5;
  };
  EXPECT_TRUE(waited(alone));
  press("Escape");
  EXPECT_TRUE(waited([&] { return same(caption(second), caption(screenshot())); }));
  press("q");
  expect_end(0);
}

/// While the first second is stepped through: on stderr, and at the top of the controls, where no other panel pushes it out.
TEST_F(Running, ARigThatDoesNotFitIsTold) {
  constexpr Rgb8 kBad = {255, 105, 97};
  const SyntheticPair room = render_synthetic({.size = kSize}, 2);
  auto left = VideoWriter::open(at("slow_left.mp4"), kSize, 0.1), right = VideoWriter::open(at("slow_right.mp4"), kSize, 0.1);
  ASSERT_TRUE(left && right);
  for (int i = 0; i < 80; ++i) ASSERT_TRUE(left->write(room.pair.left.pixels) && right->write(room.pair.right.pixels));
  ASSERT_TRUE(left->finish() && right->finish());
  const double c = std::cos(0.3 * M_PI / 180), s = std::sin(0.3 * M_PI / 180);
  Rig tilted = room.rig;
  tilted.right_from_left = Rigid3{Mat3{{1, 0, 0, 0, c, -s, 0, s, c}}, {}} * room.rig.right_from_left;
  ASSERT_TRUE(save_rig(tilted, at("tilted.json")));
  const auto red = [&](const Image<Rgb8>& window) { return near(window, 1280, 60, 50, kBad); };

  start("slow_left.mp4 slow_right.mp4 --rig tilted.json --model lite --paused");
  ASSERT_TRUE(waited([&] { return hues_in(screenshot().view().crop(40, 570, {520, 380})) > 5; }));
  EXPECT_EQ(red(screenshot()), 0);
  EXPECT_EQ(bytes_of(at("view_err.txt")), "");
  int presses = 0;  // each steps by one pair, or by none while the one before is worked on: the clip does not end
  EXPECT_TRUE(waited([&] {
    press(presses++ < 60 ? "Right" : "shift");
    return bytes_of(at("view_err.txt")).find("the rig does not fit these pictures") != std::string::npos;
  }));
  EXPECT_TRUE(waited([&] { return red(screenshot()) > 20; }));
  press("q");
  expect_end(0);
}

TEST_F(Running, AnInterruptCompletesTheLines) {
  start("left.mp4 right.mp4 --rig rig.json --tracker arm --loop -o interrupted.jsonl");
  wait_for_title("Click");
  kill(std::atoi(bytes_of(at("view.txt")).c_str()), SIGTERM);
  expect_end(0);
  EXPECT_NE(bytes_of(at("interrupted.jsonl")).find("header"), std::string::npos);
}

/// A driver without OpenGL 3.0 for desktops, but with OpenGL ES 3.0.
TEST_F(ViewWindow, DrawsWithOpenGlEs) {
  const Ended ended = run_tool(at(""), "view left.mp4 right.mp4 --rig rig.json --screenshot es.png --after 1",
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
    const Ended ended = run_tool(at(""), "view " + arguments, before + "ASAN_OPTIONS=detect_leaks=0 timeout 20");
    EXPECT_EQ(ended.exit, exit) << ended.err;
    EXPECT_EQ(std::count(ended.err.begin(), ended.err.end(), '\n'), 1) << ended.err;
    EXPECT_NE(ended.err.find(words), std::string::npos) << ended.err;
    EXPECT_EQ(ended.out, "");
  };
  const std::string clip = "left.mp4 right.mp4 --rig rig.json";
  fails(clip, kInput, "there is no display", "env -u DISPLAY -u WAYLAND_DISPLAY ");
  const std::string old_card = "MESA_GL_VERSION_OVERRIDE=2.1 MESA_GLES_VERSION_OVERRIDE=2.0 ";
  fails(clip, kInput, "there is no driver for OpenGL 3.0", display() + old_card);
  fails("left.png right.png", kInput, "it does not bring a rig; give one with --rig", display());
  fails("none.mp4 right.mp4 --rig rig.json", kInput, "none.mp4", display());
  fails(clip + " -o none/lines.jsonl", kOutput, "make the folder first", display());
  fails(clip + " --screenshot none/window.png", kOutput, "make the folder first", display());
  fails(clip + " --screenshot window.png --after 99", kInput, "ends after 6 pairs", display());
}

}  // namespace
}  // namespace duo::window_test
