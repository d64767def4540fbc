// Reports of values by hand: the words of a line, the fields of a document.
#include "duoptic/reports.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

namespace duo {
namespace {

using nlohmann::json;

Rig rig() {
  Rig rig;
  rig.left = {{640, 480}, 500, 500, 320, 240, {}};
  rig.right = {{640, 480}, 510, 510, 320, 240, {}};
  const double roll = 0.01;  // about z; the rotation's sine, turns_deg() takes it for the angle
  rig.right_from_left = {{1, -roll, 0, roll, 1, 0, 0, 0, 1}, {-0.12, 0, 0}};
  return rig;
}

TEST(Reports, OfARig) {
  EXPECT_EQ(text_of(rig()),
            "640x480, focal lengths 500.0 and 510.0 px, 120.0 mm apart, right camera turned by tilt 0.00, pan 0.00, roll 0.57 "
            "degrees");
  const json out = json::parse(json_of(rig()));
  EXPECT_EQ(out["width"], 640);
  EXPECT_EQ(out["baseline_m"], 0.12);
  EXPECT_TRUE(out["metric"].get<bool>());
  EXPECT_NEAR(out["turns_deg"][2].get<double>(), 0.573, 1e-3);
}

TEST(Reports, OfWhatPairsSayOfARig) {
  EXPECT_EQ(json_of(std::optional<RigFit>()), "null");
  RigFit fit{.verdict = RigVerdict::kRecalibrate, .what = "rows"};
  EXPECT_TRUE(json::parse(json_of(std::optional(fit)))["scene"].is_null());
  fit.scene.emplace();
  fit.scene->pairs = 1, fit.scene->points = 70, fit.scene->row_px = 2;
  const json out = json::parse(json_of(std::optional(fit)));
  EXPECT_EQ(out["verdict"], "recalibrate");
  EXPECT_EQ(out["scene"]["row_px"], 2);
  EXPECT_TRUE(text_of(*fit.scene).starts_with("points   70 in 1 pair, in 0 % of the picture\nrows     2.00 px off"));
}

TEST(Reports, OfARecording) {
  RecordingReport report;
  report.left = {"MJPEG", 31, 0}, report.right = {"MJPEG", 31, 2};
  report.pairs = 31, report.length_s = 1;
  EXPECT_NE(text_of(report).find("31 pairs in 1.00 s, 30.00 a second"), std::string::npos);
  EXPECT_NE(text_of(report).find("rig      none"), std::string::npos);
  report.rig = rig();
  const json out = json::parse(json_of(report, "clip\xff.mkv", {"left.avi"}));  // a name that is no UTF-8
  EXPECT_EQ(out["rate_hz"], 30);
  EXPECT_EQ(out["right"]["missing"], 2);
  EXPECT_EQ(out["rig"]["left_focal_px"], 500);
  EXPECT_EQ(out["files"][0], "left.avi");
}

TEST(Reports, OfDepthQualityNameFiguresThatAreKnown) {
  DepthQuality q;
  q.frames = 1;
  EXPECT_EQ(text_of(q, {10, 20, 30, 40}, true).find("temporal noise"), std::string::npos);
  EXPECT_TRUE(json::parse(json_of(q, {10, 20, 30, 40}, true, {}))["temporal_noise_mm"].is_null());
  EXPECT_EQ(lines_of(q).size(), 3U);
  q.frames = 2, q.z_error_mm = 3, q.z_accuracy_percent = 0.2;
  EXPECT_NE(text_of(q, {10, 20, 30, 40}, false).find("z error         +3.0 thousandths = +0.20 %"), std::string::npos);
  EXPECT_EQ(json::parse(json_of(q, {10, 20, 30, 40}, true, {}))["z_error_mm"], 3);
  EXPECT_EQ(lines_of(q).size(), 5U);
}

TEST(Reports, OfJointsSayWhatNoFrameTold) {
  ClipScore score;
  score.clip = "wave", score.tracker = "body";
  JointScore hand;
  hand.median_mm = 21.5, hand.frames_to_recover = 4, hand.recovered = false;
  score.joints = {{JointId::kRightHand, hand}};
  const std::vector<ClipScore> scores = {score};
  const std::string text = text_of(scores);
  EXPECT_NE(text.find("wave               body     right_hand         21.5        -        -       >4"), std::string::npos)
      << text;
  const json out = json::parse(json_of(scores, 0, ""))["clips"][0];
  EXPECT_EQ(out["joints"]["right_hand"]["median_mm"], 21.5);
  EXPECT_TRUE(out["joints"]["right_hand"]["p95_mm"].is_null());
  EXPECT_TRUE(out["depth"].is_null());
}

/// Scenes whose bad pixels are these at every threshold and in every region.
MethodScores method(const std::string& name, const std::vector<std::pair<std::string, double>>& scenes) {
  MethodScores out{name, {}};
  for (const auto& [scene, percent] : scenes) {
    SceneScore& score = out.scenes.emplace_back();
    score.scene = scene;
    for (auto& regions : score.score.bad_filled) regions.fill(percent);
    for (auto& regions : score.score.bad_holes) regions.fill(2 * percent);
  }
  return out;
}

TEST(Reports, OfScenesHaveTheMeanOfVersion2WhereAllFourAreThere) {
  const std::vector<MethodScores> three = {method("a", {{"tsukuba", 1}, {"venus", 2}, {"teddy", 3}})};
  EXPECT_EQ(three[0].filled_percent(1), 2);
  EXPECT_EQ(three[0].holes_bad_percent(1), 4);
  EXPECT_EQ(three[0].part(1, 3).filled_percent(0), 2.5);
  EXPECT_FALSE(three[0].has_v2());
  EXPECT_EQ(text_of(three, {}).find("thesis of 2010"), std::string::npos);
  const std::vector<MethodScores> all = {method("a", {{"tsukuba", 1}, {"venus", 2}, {"teddy", 3}, {"cones", 4}, {"own", 100}})};
  EXPECT_TRUE(all[0].has_v2());
  EXPECT_EQ(all[0].v2().filled_percent(1), 2.5);
  EXPECT_NE(text_of(all, {}).find("thesis of 2010"), std::string::npos);
  const json out = json::parse(json_of(all, {{"here", 3, 5}}));
  EXPECT_EQ(out["methods"][0]["v2_mean"]["bad_filled_percent"][1], 2.5);
  EXPECT_EQ(out["folders"][0]["methods"][0]["mean"]["bad_filled_percent"][0], 52);
  const json faults = json::parse(json_of({{"noise", {method("a", {{"tsukuba", 4}})}}}, {method("a", {{"tsukuba", 1}})}));
  EXPECT_EQ(faults["perturbed"][0]["methods"][0]["added_holes_percent"], 6);
}

TEST(Reports, OfABatch) {
  BatchStatus status;
  status.done = 3, status.cut = 1, status.running = 1, status.missing = 2;
  status.tasks.resize(6);
  EXPECT_EQ(line_of(status), "3 of 6 done (1 cut), 1 running, 2 missing");
  status.left_s = 90;
  EXPECT_EQ(line_of(status), "3 of 6 done (1 cut), 1 running, 2 missing, about 2 min left");
}

}  // namespace
}  // namespace duo
