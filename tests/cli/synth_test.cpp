// `duoptic synth` from outside: the clip it leaves, and what it says of bad options.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "duoptic/source.h"
#include "tool.h"

namespace duo {
namespace {

namespace fs = std::filesystem;
using test::Ended;
using test::kOutput;
using test::kUsage;

Ended run(const test::TempFolder& folder, const std::string& arguments) {
  return test::run_tool(folder / "", "synth " + arguments);
}

TEST(Synth, LeavesAClip) {
  const test::TempFolder folder;
  const std::string clip = folder / "clip";
  const Ended ended = run(folder, "--script reach --frames 3 --size 96x72 --seed 5 --arm left --threads 1 --quiet -o " + clip);
  ASSERT_EQ(ended.exit, 0) << ended.err;
  EXPECT_EQ(ended.err, "");
  EXPECT_NE(ended.out.find("3 frames of 'reach', 96x72, seed 5"), std::string::npos) << ended.out;
  const auto meta = nlohmann::json::parse(test::bytes_of(clip + "/truth.json"))["meta"];
  EXPECT_EQ(meta["selected_arm"], "left");
  EXPECT_EQ(meta["width"], 96);
  const auto pairs = open_pairs(clip + "/left.avi", clip + "/right.avi");
  ASSERT_TRUE(pairs.has_value());
  EXPECT_EQ((*pairs)->count(), 3);
  EXPECT_EQ((*pairs)->size(), (Size{96, 72}));

  // The number of threads does not show.
  const std::string again = folder / "again";
  ASSERT_EQ(run(folder, "--script reach --frames 3 --size 96x72 --seed 5 --arm left --threads 2 -o " + again).exit, 0);
  for (const char* name : {"/left.avi", "/right.avi", "/calibration_truth.yml", "/depth/depth_0000.png"})
    EXPECT_EQ(test::bytes_of(clip + name), test::bytes_of(again + name)) << name;
}

TEST(Synth, SaysInOneLineWhatIsWrong) {
  const test::TempFolder folder;
  const std::string clip = folder / "clip";
  test::put(folder / "file", "not a folder");
  const std::pair<std::string, int> wrong[] = {{"-o " + clip + " --script dance", kUsage},
                                               {"-o " + clip + " --size 640", kUsage},
                                               {"-o " + clip + " --size 0x480", kUsage},
                                               {"-o " + clip + " --frames -1", kUsage},
                                               {"-o " + clip + " --arm both", kUsage},
                                               {"", kUsage},
                                               {"--quiet --size 64x48 -o " + std::string(folder / "file"), kOutput},
                                               {"--quiet --size 64x48 -o " + std::string(folder / "file") + "/clip", kOutput}};
  for (const auto& [arguments, exit] : wrong) {
    const Ended ended = run(folder, arguments);
    EXPECT_EQ(ended.exit, exit) << arguments;
    EXPECT_EQ(std::count(ended.err.begin(), ended.err.end(), '\n'), 1) << arguments << ": " << ended.err;
    EXPECT_FALSE(fs::exists(clip)) << arguments;
  }
}

}  // namespace
}  // namespace duo
