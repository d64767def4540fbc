// The evaluation on the real scenes: the figures that the README promises, and OpenCV's as others measured them.
#include <gtest/gtest.h>

#include <cstdio>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <string>

#include "tests/data.h"

namespace duo {
namespace {

/// The JSON of `duoptic eval middlebury` on the four scenes of version 2.
nlohmann::json evaluate(const std::filesystem::path& data, const std::string& options) {
  std::string command = DUO_TOOL " eval middlebury";
  for (const char* scene : {"tsukuba", "venus", "teddy", "cones"})
    command += " '" + (data / "middlebury" / scene).string() + "'";
  FILE* pipe = popen((command + " --json " + options).c_str(), "r");
  std::string out;
  for (int c = std::fgetc(pipe); c != EOF; c = std::fgetc(pipe)) out += static_cast<char>(c);
  EXPECT_EQ(pclose(pipe), 0);
  return nlohmann::json::parse(out, nullptr, false);
}

double v2_mean(const nlohmann::json& report, const std::string& method, const char* column) {
  for (const auto& m : report["methods"])
    if (m["method"] == method) return m["v2_mean"][column][1];
  ADD_FAILURE() << "no method " << method;
  return 0;
}

// Large walls with little texture, where the brightness of both views differs: OpenCV is printed beside ours in the same call.
TEST(Eval, FiguresOnWalls) {
  const std::filesystem::path walls = test::data_folder() / "middlebury_walls";
  if (!std::filesystem::exists(walls)) GTEST_SKIP() << "skipped: no data";
  FILE* pipe = popen((DUO_TOOL " eval middlebury --json '" + walls.string() + "'").c_str(), "r");
  std::string out;
  for (int c = std::fgetc(pipe); c != EOF; c = std::fgetc(pipe)) out += static_cast<char>(c);
  ASSERT_EQ(pclose(pipe), 0);
  std::map<std::string, double> bad;
  const nlohmann::json report = nlohmann::json::parse(out);
  for (const auto& m : report["methods"]) bad[m["method"]] = m["mean"]["bad_filled_percent"][1];
  EXPECT_LE(bad.at("duoptic sgm default, --fill"), 15.0);
  EXPECT_LE(bad.at("duoptic sgm default"), 20.0);
  EXPECT_GT(bad.at("OpenCV HH4 tuned"), bad.at("duoptic sgm default, --fill"));
  EXPECT_GT(bad.at("OpenCV 3WAY tuned"), bad.at("duoptic sgm default, --fill"));
}

TEST(Eval, FiguresOnTheFourScenes) {
  const std::filesystem::path data = test::data_folder();
  if (!std::filesystem::exists(data / "middlebury" / "cones")) GTEST_SKIP() << "skipped: no data";
  const nlohmann::json fine = evaluate(data, "");
  EXPECT_LE(v2_mean(fine, "duoptic sgm default", "bad_holes_percent"), 9.8);
  EXPECT_LE(v2_mean(fine, "duoptic sgm default, --fill", "bad_filled_percent"), 6.0);
  const nlohmann::json filled = evaluate(data, "--fill --no-peers");
  EXPECT_LE(v2_mean(filled, "duoptic sgm default", "bad_holes_percent"), 6.0);
  const nlohmann::json pyramid = evaluate(data, "--matcher pyramid --no-peers");
  EXPECT_LE(v2_mean(pyramid, "duoptic pyramid default", "bad_filled_percent"), 10.0);
  EXPECT_LE(v2_mean(pyramid, "duoptic pyramid default", "bad_holes_percent"), 17.0);
  // The regions of tsukuba and venus are derived here, with other code than where these figures come from.
  EXPECT_NEAR(v2_mean(fine, "OpenCV BM usual", "bad_filled_percent"), 17.27, 0.25);
  EXPECT_NEAR(v2_mean(fine, "OpenCV BM usual", "bad_holes_percent"), 28.15, 0.25);
  EXPECT_NEAR(v2_mean(fine, "OpenCV 3WAY tuned", "bad_filled_percent"), 7.65, 0.25);
  EXPECT_NEAR(v2_mean(fine, "OpenCV 3WAY tuned", "bad_holes_percent"), 10.22, 0.25);
  const nlohmann::json thesis = evaluate(data, "--preset thesis --no-peers");
  EXPECT_LE(v2_mean(thesis, "duoptic pyramid thesis", "bad_filled_percent"), 24.0);
}

// Under each fault of two unlike webcams the default loses less than OpenCV's 3WAY at the parameters that suit these scenes
// best.
TEST(Eval, FaultsCostLessThanTheyCostOpenCv) {
  const std::filesystem::path data = test::data_folder();
  if (!std::filesystem::exists(data / "middlebury" / "cones")) GTEST_SKIP() << "skipped: no data";
  const nlohmann::json report = evaluate(data, "--perturb");
  ASSERT_EQ(report["perturbed"].size(), 4u);
  for (const auto& row : report["perturbed"]) {
    std::map<std::string, double> added;
    for (const auto& m : row["methods"]) added[m["method"]] = m["added_filled_percent"];
    EXPECT_LT(added.at("duoptic sgm default"), added.at("OpenCV 3WAY tuned")) << row["fault"];
  }
}

}  // namespace
}  // namespace duo
