// `duoptic cameras` and `duoptic track` on two live cameras, which a preloaded library makes up.
#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <sstream>

#include "duoptic/rig.h"
#include "duoptic/synthetic.h"
#include "tool.h"

namespace duo {
namespace {

namespace fs = std::filesystem;
using test::bytes_of;
using test::Ended;
using test::put;
using test::TempFolder;

/// BT.601 with limited range, which webcams send.
std::string yuyv(const Image<Rgb8>& picture) {
  std::string bytes;
  const auto byte = [](double value) { return static_cast<char>(static_cast<unsigned char>(std::lround(value))); };
  for (int y = 0; y < picture.height(); ++y)
    for (int x = 0; x < picture.width(); ++x) {
      const auto [r, g, b] = picture.at(y, x);
      const double luma = 0.299 * r + 0.587 * g + 0.114 * b;
      const double chroma = x % 2 == 0 ? (b - luma) / 1.772 : (r - luma) / 1.402;
      bytes += {byte(16 + luma * 219 / 255), byte(128 + chroma * 224 / 255)};
    }
  return bytes;
}

class Cameras : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    shared_ = std::make_unique<TempFolder>();
    const TempFolder& folder = *shared_;
    const SyntheticPair room = render_synthetic({.size = {320, 240}}, 2);
    put(folder / "left.yuyv", yuyv(room.pair.left.pixels));
    put(folder / "right.yuyv", yuyv(room.pair.right.pixels));
    ASSERT_TRUE(save_rig(room.rig, folder / "rig.json"));
    ASSERT_TRUE(save_rig(synthetic_rig({.size = {1280, 720}}), folder / "large.json"));
  }

  static void TearDownTestSuite() { shared_.reset(); }

  Ended run(const std::string& arguments) { return test::run_tool(folder_ / "", arguments, kPreload); }

  /// Runs the tool while shell words `meanwhile` run beside it, then sends it Ctrl-C. No wait_for waits longer than 20 s.
  Ended run_live(const std::string& arguments, const std::string& meanwhile) {
    constexpr char kWaitFor[] = R"sh(
wait_for() {  # shell words; until they hold
  for i in $(seq 400); do eval "$1" && return 0; sleep 0.05; done
  echo "never came: $1" >&2; kill -9 $tool; exit 99
}
lines() { [ "$(wc -l <out.txt)" -ge "$1" ]; }
)sh";
    put(folder_ / "live.sh", kWaitFor + std::string(kPreload) + " '" DUO_TOOL "' " + arguments +
                                 " >out.txt 2>err.txt &\ntool=$!\n" + meanwhile + "\nkill -INT $tool\nwait $tool\n");
    const int status = std::system(("cd '" + (folder_ / "").string() + "' && sh live.sh 2>script.txt").c_str());
    return {WEXITSTATUS(status), bytes_of(folder_ / "out.txt"),
            bytes_of(folder_ / "err.txt") + bytes_of(folder_ / "script.txt")};
  }

  // A sanitizer's run time that is a library wants to be the first one; ours may come before it, it replaces nothing of it.
  static constexpr char kPreload[] =
      "DUO_FAKE_FOLDER=. ASAN_OPTIONS=$ASAN_OPTIONS:verify_asan_link_order=0 LD_PRELOAD='" DUO_FAKE_CAMERAS "'";
  inline static std::unique_ptr<TempFolder> shared_;
  const TempFolder& folder_ = *shared_;
};

TEST_F(Cameras, AreListedWithWhichGoTogether) {
  const Ended ended = run("cameras --json");
  ASSERT_EQ(ended.exit, 0) << ended.err;
  const auto json = ended.json();
  ASSERT_EQ(json["cameras"].size(), 2u) << ended.out;
  const auto& right = json["cameras"][1];
  EXPECT_EQ(right["source"], "camera:2");
  EXPECT_EQ(right["path"], "/dev/video2");
  EXPECT_EQ(right["name"], "Fake webcam");
  EXPECT_EQ(right["bus_path"], "usb-0000:00:14.0-2");
  EXPECT_EQ(right["serial"], "R1");
  EXPECT_EQ(right["usb_mbit_s"], 480);
  EXPECT_EQ(right["modes"].size(), 3u);
  EXPECT_EQ(right["modes"][0]["rates_hz"], nlohmann::json{30.0});
  ASSERT_EQ(json["pairs"].size(), 1u);
  EXPECT_EQ(json["pairs"][0]["left"], "camera:0");
  EXPECT_EQ(json["pairs"][0]["format"], "MJPG");  // one USB 2 controller has no room for two raw streams
  const Ended text = run("cameras");
  EXPECT_NE(text.out.find("together: camera:0 camera:2, 640x480 at 30 Hz as MJPG"), std::string::npos) << text.out;
}

TEST_F(Cameras, NoneIsOneLineAndWhatToDo) {
  if (fs::exists("/dev/video0")) GTEST_SKIP() << "skipped: this machine has a camera";
  const Ended ended = test::run_tool(folder_ / "", "cameras");
  EXPECT_EQ(ended.exit, 4);
  EXPECT_EQ(ended.err.rfind("duoptic cameras: no camera found; plug one in", 0), 0u) << ended.err;
  EXPECT_EQ(std::count(ended.err.begin(), ended.err.end(), '\n'), 1);
}

constexpr char kTrack[] = "track camera:0 camera:2 --select hand=160,100 --select elbow=160,77 --select shoulder=160,54 ";

TEST_F(Cameras, WrongSizesAndNamesAreRefused) {
  const Ended large = run(kTrack + std::string("--rig large.json"));
  EXPECT_EQ(large.exit, 4);
  EXPECT_NE(large.err.find("has no 1280x720"), std::string::npos) << large.err;
  // One camera with both views gives them in one picture.
  for (const auto& [layout, size] : {std::pair("", "2560x720"), std::pair("--layout top-bottom", "1280x1440")}) {
    const Ended both = run(std::string("depth camera:0 --rig large.json -o d ") + layout);
    EXPECT_EQ(both.exit, 4);
    EXPECT_NE(both.err.find(std::string("has no ") + size), std::string::npos) << both.err;
  }
  const Ended none = run("track camera:0 camera:1 --select hand=1,1 --select elbow=2,2 --select shoulder=3,3 --rig rig.json");
  EXPECT_EQ(none.exit, 4);
  EXPECT_NE(none.err.find("/dev/video1: no such camera"), std::string::npos) << none.err;
}

TEST_F(Cameras, CtrlCEndsDepthAndWhatHasNotBegun) {
  const Ended depth = run_live("depth camera:0 camera:2 --rig rig.json --matcher pyramid --every 5 --far 0.2 -o d",
                               "wait_for 'ls d/frame_*/depth.png'");
  EXPECT_EQ(depth.exit, 0) << depth.err;
  EXPECT_NE(depth.err.find("lies farther than --far 0.2"), std::string::npos) << depth.err;
  const Ended track = run_live(kTrack + std::string("--rig rig.json --at-frame 9999 -o never.jsonl"),
                               "wait_for 'grep -q locked err.txt'");  // said after a second of pictures
  EXPECT_EQ(track.exit, 4) << track.err;
  EXPECT_NE(track.err.find("stopped before frame 9999"), std::string::npos) << track.err;
  EXPECT_FALSE(fs::exists(folder_ / "never.jsonl"));
}

/// Tracks until 20 lines are there, pulls the right camera out, plugs it in again, and ends after ten more.
TEST_F(Cameras, TrackLiveThroughUnpluggingUntilCtrlC) {
  const Ended ended = run_live(kTrack + std::string("--rig rig.json --matcher pyramid --stats --video a.mp4"), R"sh(
wait_for "lines 20"
touch unplugged
wait_for "grep -q 'camera:2 is away' err.txt"
rm unplugged
wait_for "grep -q 'camera:2 is back' err.txt"
lines=$(wc -l <out.txt)
wait_for "lines $((lines + 10))")sh");
  ASSERT_EQ(ended.exit, 0) << ended.err;
  EXPECT_NE(ended.err.find("dropped"), std::string::npos) << ended.err;
  EXPECT_TRUE(fs::exists(folder_ / "a.mp4"));  // ended, or it would not have its name

  std::istringstream all(ended.out);
  std::string line;
  std::getline(all, line);
  double last_s = -1;
  int frames = 0;
  while (std::getline(all, line)) {
    const auto frame = nlohmann::json::parse(line, nullptr, false);
    ASSERT_TRUE(frame.is_object()) << line;
    EXPECT_NEAR(frame["skew_ms"], 5.0, 1.0);
    EXPECT_GT(frame["t_s"], last_s);
    last_s = frame["t_s"];
    EXPECT_EQ(frame["people"][0]["joints"].size(), 3u);
    ++frames;
  }
  EXPECT_GE(frames, 29);
  EXPECT_LT(last_s, 60);  // time did not jump
}

}  // namespace
}  // namespace duo
