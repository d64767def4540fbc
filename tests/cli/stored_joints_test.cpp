// Joints do not change by accident: what JSON lines of version 1 said of clips is said in version 2, to the last digit.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>

#include "tests/data.h"
#include "tool.h"

namespace duo {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

constexpr const char* kParts[] = {"hand", "elbow", "shoulder"};

/// tests/data/version_1/NAME.jsonl has lines of frames, not of all of them.
struct Stored {
  const char *name, *clip, *options;
  std::size_t arms;
  bool long_run = false;  // there alone: each matcher, tracker and clip has its turn without it
};
std::ostream& operator<<(std::ostream& out, const Stored& stored) { return out << stored.name; }

/// The sides of a clip's arms, the one that moves first.
std::vector<std::string> sides_of(const json& truth, std::size_t arms) {
  const bool left = truth["meta"]["selected_arm"] == "left";
  std::vector<std::string> sides = {left ? "left" : "right", left ? "right" : "left"};
  sides.resize(arms);
  return sides;
}

/// The first frame that shows the arms, and clicks on them there.
std::string selection(const json& truth, const std::vector<std::string>& sides) {
  for (const json& frame : truth["frames"]) {
    std::string out = fmt::format(" --at-frame {}", frame["frame"].get<int>());
    bool visible = true;
    for (const std::string& side : sides)
      for (const char* part : kParts) {
        const std::string name = side + "_" + part;
        const json& joint = frame["joints"][name];
        visible = visible && joint["vis_left"] && joint["vis_right"];
        if (visible) out += fmt::format(" --select {}={},{}", name, joint["uv_left"][0].dump(), joint["uv_left"][1].dump());
      }
    if (visible) return out;
  }
  return " --select none";
}

class StoredJoints : public testing::TestWithParam<Stored> {
 protected:
  static void SetUpTestSuite() {
    folder_ = std::make_unique<test::TempFolder>();
    const auto rendered =
        test::run_tool(*folder_ / "", "synth --script wave --frames 24 --size 320x240 --seed 1 --quiet -o synthetic");
    ASSERT_EQ(rendered.exit, 0) << rendered.err;
  }
  static void TearDownTestSuite() { folder_.reset(); }
  inline static std::unique_ptr<test::TempFolder> folder_;
};

TEST_P(StoredJoints, AreTheSameToTheLastDigit) {
  const auto& [name, clip, options, arms, long_run] = GetParam();
  if (long_run && !test::long_run()) GTEST_SKIP() << "skipped: only with DUOPTIC_LONG";
  const bool synthetic = std::string(clip) == "synthetic";
  const fs::path at = synthetic ? *folder_ / clip : test::data_folder() / "sequences" / clip;
  if (!fs::exists(at)) GTEST_SKIP() << "skipped: no data";
  const auto truth = json::parse(test::bytes_of(at / "truth.json"));
  const std::vector<std::string> sides = sides_of(truth, arms);
  const auto ended = test::run_tool(
      *folder_ / "",
      fmt::format("track {0}/left.avi {0}/right.avi --rig {0}/calibration_truth.yml --quiet --engine simd {1}{2}",
                  fs::absolute(at).string(), options, selection(truth, sides)));
  ASSERT_EQ(ended.exit, 0) << ended.err;
  std::map<std::int64_t, json> lines;
  std::istringstream text(ended.out);
  std::string line;
  for (std::getline(text, line); std::getline(text, line);) {
    const json frame = json::parse(line);
    lines[frame["frame"]] = frame;
  }
  std::ifstream stored(fs::path("tests/data/version_1") / (std::string(name) + ".jsonl"));
  int joints = 0;
  while (std::getline(stored, line)) {
    const json want = json::parse(line), got = lines[want["frame"]];
    ASSERT_EQ(want["t_s"], got["t_s"]);
    ASSERT_EQ(got["people"].size(), arms);
    for (std::size_t a = 0; a < arms; ++a)
      for (const char* part : kParts) {
        ASSERT_EQ(want[a == 0 ? "joints" : "joints2"][part], got["people"][a]["joints"][sides[a] + "_" + part])
            << "frame " << want["frame"] << " " << part;
        ++joints;
      }
  }
  EXPECT_GE(joints, 40);
}

INSTANTIATE_TEST_SUITE_P(
    Clips, StoredJoints,
    testing::Values(Stored{"synthetic_sgm", "synthetic", "--matcher sgm", 1},
                    Stored{"synthetic_pyramid_both", "synthetic", "--matcher pyramid", 2},
                    Stored{"synthetic_thesis", "synthetic", "--matcher sgm --tracker thesis", 1},
                    Stored{"dev_easy_wave_sgm", "dev_easy_wave", "--matcher sgm", 1},
                    Stored{"dev_easy_wave_pyramid", "dev_easy_wave", "--matcher pyramid", 1, true},
                    Stored{"dev_easy_wave_thesis", "dev_easy_wave", "--matcher sgm --tracker thesis", 1, true},
                    Stored{"dev_hard_beige_sgm", "dev_hard_beige", "--matcher sgm", 1, true},
                    Stored{"dev_hard_beige_pyramid", "dev_hard_beige", "--matcher pyramid", 1},
                    Stored{"dev_hard_beige_thesis", "dev_hard_beige", "--matcher sgm --tracker thesis", 1}),
    [](const auto& info) { return std::string(info.param.name); });

}  // namespace
}  // namespace duo
