// Tables of short runs: every contestant is there, and what is said is what the table has.
#include "duoptic/bench.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

namespace duo {
namespace {

TEST(Bench, FramesBesideOpenCV) {
  const SyntheticPair input = render_synthetic({.size = {160, 160}}, 2);
  std::string said;
  const auto table = bench_frames(input, {"simd", 2, 1, false}, [&](const std::string& text) { said += text; });
  ASSERT_TRUE(table) << table.error().what;
  const nlohmann::json out = nlohmann::json::parse(*table);
  EXPECT_EQ(out["threads"], 2);
  ASSERT_EQ(out["ours"].size(), 5U);
  ASSERT_EQ(out["peers"].size(), 4U);
  for (const auto& one : out["ours"]) {
    const auto name = one["name"].get<std::string>();
    EXPECT_GE(one["whole"]["wall_ms"].get<double>(), one["matching"]["wall_ms"].get<double>()) << name;
    EXPECT_EQ(one["ratio_to"].size(), 4U) << name;
    EXPECT_NE(said.find(name), std::string::npos) << name;
  }
  EXPECT_NE(said.find("160x160, 128 disparities, 2 threads"), std::string::npos) << said;
}

TEST(Bench, MediansOfTimes) {
  EXPECT_EQ(median_of(std::vector<double>()), 0);
  const Times median = median_of({{1, 20}, {3, 10}, {2, 30}});
  EXPECT_EQ(median.wall_ms, 2);
  EXPECT_EQ(median.cpu_ms, 20);
  EXPECT_GE(timed([] {}).wall_ms, 0);
}

}  // namespace
}  // namespace duo
