// `depth --frames`: each part of a video gives the files that a run of all gives, byte for byte.
#include <gtest/gtest.h>

#include "duoptic/rig.h"
#include "tests/turned_rig.h"
#include "tool.h"

namespace duo {
namespace {

namespace fs = std::filesystem;
using test::bytes_of;
using test::kInput;
using test::kUsage;

/// A waving person, right pictures 12 ms late, and a rig whose right camera was turned since.
class DepthFrames : public ::testing::Test {
 protected:
  static constexpr int kFrames = 40;

  static void SetUpTestSuite() {
    folder_ = std::make_unique<test::TempFolder>();
    ASSERT_EQ(run("synth --script wave --frames 40 --size 320x240 --skew-ms 12 --quiet -o clip").exit, 0);
    auto rig = load_rig(at("clip/calibration_truth.yml"));
    ASSERT_TRUE(rig);
    ASSERT_TRUE(save_rig(test::right_turned(*rig, test::turn(0.3, 0, 0)), at("rig.json")));
    ASSERT_EQ(run("record clip/left.avi clip/right.avi --rig rig.json --quiet -o clip.mkv").exit, 0);
  }
  static void TearDownTestSuite() { folder_.reset(); }

  static fs::path at(const std::string& name) { return *folder_ / name; }
  static test::Ended run(const std::string& arguments) { return test::run_tool(at(""), arguments); }

  /// By path in `folder`.
  static std::map<std::string, std::string> files_in(const fs::path& folder) {
    std::map<std::string, std::string> out;
    for (const auto& entry : fs::recursive_directory_iterator(folder))
      if (entry.is_regular_file()) out[fs::relative(entry.path(), folder)] = bytes_of(entry.path());
    return out;
  }
  static std::string frame_of(const std::string& path) { return path.substr(0, 12); }

 private:
  inline static std::unique_ptr<test::TempFolder> folder_;
};

TEST_F(DepthFrames, PartsAreTheWholeToTheByte) {
  const std::string how = " --outputs disparity,depth,camera --max-disparity 48 --engine simd --threads 2 --quiet";
  for (const std::string input :
       {"clip/left.avi clip/right.avi --rig rig.json --skew-ms 12", "clip.mkv", "clip.mkv --every 3"}) {
    SCOPED_TRACE(input);
    ASSERT_EQ(run("depth " + input + how + " -o whole").exit, 0);
    const auto whole = files_in(at("whole"));
    ASSERT_GE(whole.size(), 39u);
    std::size_t found = 0;
    for (const std::string range : {":1", "1:2", "2:20", "20:32", "32:"}) {
      const auto ended = run("depth " + input + how + " --frames " + range + " -o part");
      ASSERT_EQ(ended.exit, 0) << range << ended.err;
      if (!fs::exists(at("part"))) continue;  // no third frame among them
      for (const auto& [path, bytes] : files_in(at("part"))) {
        ++found;
        ASSERT_TRUE(whole.contains(path)) << range << path;
        EXPECT_EQ(whole.at(path) == bytes, true) << range << " " << path;
      }
      fs::remove_all(at("part"));
    }
    EXPECT_EQ(found, whole.size());
    fs::remove_all(at("whole"));
  }
  // The comparison sees that the rig is judged by the first second, which tells how sure later disparities are.
  ASSERT_EQ(run("depth clip.mkv --frames 39: --outputs camera --quiet -o late").exit, 0);
  EXPECT_GT(nlohmann::json::parse(bytes_of(at("late/frame_000039/camera.json"))).value("disparity_sigma_px", 0.0), 0);
}

TEST_F(DepthFrames, WhatIsNoRange) {
  const std::string depth = "depth clip.mkv --quiet -o out --frames ";
  for (const std::string range : {"5", "5:5", "6:5", "-1:4", "a:b", "1:2:3", "1e3:"})
    EXPECT_EQ(run(depth + range).exit, kUsage) << range;
  const auto beyond = run(depth + "40:50");
  EXPECT_EQ(beyond.exit, kInput);
  EXPECT_TRUE(beyond.err.ends_with("duoptic depth: cannot give frames 40:50: clip.mkv gives 40 pairs, numbered from 0\n"))
      << beyond.err;
  EXPECT_FALSE(fs::exists(at("out")));
  EXPECT_EQ(run(depth + "38:50 --outputs disparity --json").json().value("frames", 0), 2);
}

}  // namespace
}  // namespace duo
