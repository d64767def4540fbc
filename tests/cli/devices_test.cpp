// `duoptic devices`, and the tool's engine on one of them: the software driver here, whose answers are those of any.
#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <sstream>

#include "tool.h"

namespace duo {
namespace {

using test::kInput;
constexpr char kDevice[] = " --engine vulkan:llvmpipe";

class Devices : public ::testing::Test {
 protected:
  void SetUp() override {
    if (const char* none = std::getenv("DUOPTIC_NO_VULKAN"); none != nullptr && std::string(none) == "1")
      GTEST_SKIP() << "skipped: no Vulkan";
  }
  /// Drivers are unloaded before leaks are looked for, so that theirs cannot be told from ours.
  test::Ended run(const std::string& arguments) const {
    return test::run_tool(folder_ / "", arguments, "ASAN_OPTIONS=detect_leaks=0");
  }

  /// A clip of the rendered person in `folder_`, and the clicks on its arm.
  std::string make_clip() const {
    const test::Ended made = run("synth --quiet --frames 6 --size 320x240 -o clip");
    EXPECT_EQ(made.exit, 0) << made.err;
    const auto truth = nlohmann::json::parse(test::bytes_of(folder_ / "clip/truth.json"));
    const std::string side = truth["meta"]["selected_arm"].get<std::string>() + "_";
    std::string clicks;
    for (const std::string joint : {"hand", "elbow", "shoulder"}) {
      const auto& uv = truth["frames"][0]["joints"][side + joint]["uv_left"];
      clicks += " --select " + joint + "=" + uv[0].dump() + "," + uv[1].dump();
    }
    return "track clip/left.avi clip/right.avi --rig clip/calibration_truth.yml" + clicks;
  }

  test::TempFolder folder_;
};

TEST_F(Devices, ListsThem) {
  const auto all = run("devices --json").json();
  ASSERT_FALSE(all.empty());
  for (std::size_t i = 0; i < all.size(); ++i) {
    EXPECT_EQ(all[i]["index"], i);
    EXPECT_FALSE(all[i]["name"].get<std::string>().empty());
    EXPECT_TRUE(all[i]["lacks"].is_array());
  }
  const test::Ended text = run("devices");
  EXPECT_EQ(text.exit, 0);
  EXPECT_NE(text.out.find(all[0]["name"]), std::string::npos) << text.out;
}

TEST_F(Devices, SayWhichOnesThereAreWhenTheWantedOneIsNot) {
  make_clip();
  for (const char* engine : {"vulkan:no such card", "vulkan:99"}) {
    const test::Ended ended = run(
        std::string("depth clip/left.avi clip/right.avi --rig clip/calibration_truth.yml -o out --engine '") + engine + "'");
    EXPECT_EQ(ended.exit, kInput);
    EXPECT_NE(ended.err.find("there are 0: "), std::string::npos) << ended.err;
    EXPECT_EQ(std::count(ended.err.begin(), ended.err.end(), '\n'), 1) << ended.err;
  }
}

std::vector<nlohmann::json> lines(const std::string& text) {
  std::vector<nlohmann::json> out;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) out.push_back(nlohmann::json::parse(line));
  return out;
}

/// Of two lines; `within_m` where points may differ in their last bits, else to the last digit.
void expect_same_joints(const nlohmann::json& want, const nlohmann::json& got, double within_m) {
  if (within_m == 0) {
    EXPECT_EQ(want, got);
    return;
  }
  const auto &wanted = want["people"][0]["joints"], &given = got["people"][0]["joints"];
  ASSERT_EQ(wanted.size(), 3u);
  for (const auto& [name, joint] : wanted.items()) {
    const auto &at = joint["p_in_rig_m"], &found = given[name]["p_in_rig_m"];
    EXPECT_EQ(joint["state"], given[name]["state"]) << want;
    ASSERT_EQ(at.size(), found.size());
    for (std::size_t i = 0; i < at.size(); ++i) EXPECT_NEAR(at[i].get<double>(), found[i].get<double>(), within_m) << want;
  }
}

/// What was said beside the progress that a slow run shows.
std::string without_progress(const std::string& said) {
  std::istringstream lines(said);
  std::string out;
  for (std::string line; std::getline(lines, line);)
    if (!line.starts_with("duoptic track: frame ")) out += line + '\n';
  return out;
}

TEST_F(Devices, TrackLikeTheCpu) {
  const std::string track = make_clip();
  for (const bool points : {false, true}) {
    const char* preset = points ? " --preset thesis --tracker thesis" : " --preset default";
    const test::Ended cpu = run(track + preset + " --engine simd"), device = run(track + preset + kDevice);
    ASSERT_EQ(cpu.exit, 0) << cpu.err;
    ASSERT_EQ(device.exit, 0) << device.err;
    EXPECT_EQ(without_progress(device.err), "") << "nothing was taken over by the CPU";
    const auto want = lines(cpu.out), got = lines(device.out);
    ASSERT_EQ(want.size(), 7u);
    ASSERT_EQ(got.size(), want.size());
    EXPECT_EQ(got[0]["engine"], "vulkan");
    EXPECT_NE(got[0]["device"].get<std::string>().find("llvmpipe"), std::string::npos);
    EXPECT_TRUE(want[0]["device"].is_null());
    for (std::size_t i = 1; i < want.size(); ++i) expect_same_joints(want[i], got[i], points ? 0.003 : 0);
  }
}

}  // namespace
}  // namespace duo
