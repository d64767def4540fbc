// A rig from the scenes of the rendered clips, and a turned one put right by them; the true rigs are known.
#include <gtest/gtest.h>

#include <memory>
#include <vector>

#include "duoptic/rig_fit.h"
#include "duoptic/rig_health.h"
#include "tests/data.h"
#include "tests/turned_rig.h"

namespace duo {
namespace {

using namespace test;

class SceneClips : public testing::TestWithParam<const char*> {
 protected:
  void SetUp() override {
    folder_ = data_folder() / "sequences" / GetParam();
    if (!std::filesystem::exists(folder_)) GTEST_SKIP() << "skipped: no data";
  }
  std::unique_ptr<PairSource> pairs() const {
    auto out = open_pairs(folder_ / "left.avi", folder_ / "right.avi");
    EXPECT_TRUE(out);
    return std::move(*out);
  }
  std::filesystem::path folder_;
};

TEST_P(SceneClips, FromSceneRefineAndCheck) {
  const auto truth = load_rig(folder_ / "calibration_truth.yml");
  ASSERT_TRUE(truth);
  const auto found = rig_from_scene(*truth, truth->baseline_m(), *pairs(), 2);
  ASSERT_TRUE(found) << found.error().what;
  const Vec3 wrong = wrong_turn_deg(found->rig, *truth);
  const double row_px = true_row_error_px(found->rig, *truth);
  EXPECT_LT(row_px, 0.5);
  EXPECT_LT(std::max(std::abs(wrong.x), std::abs(wrong.z)), 0.05);
  std::printf("%s from the scene: rows %.3f px, tilt %.4f pan %.4f roll %.4f degrees\n", GetParam(), row_px, wrong.x, wrong.y,
              wrong.z);

  for (const Mat3& by : {turn(1, 0, 0), turn(0, 1, 0), turn(0, 0, 1)}) {
    const auto refined = refine_rig(right_turned(*truth, by), *pairs(), 2);
    ASSERT_TRUE(refined) << refined.error().what;
    EXPECT_EQ(refined->before.verdict, RigVerdict::kRecalibrate);
    EXPECT_EQ(refined->after.verdict, RigVerdict::kGood);
    EXPECT_LT(true_row_error_px(refined->rig, *truth), 0.5);
  }
  // Turned every way at once: where the scene does not tell the pan, the rig must not be called good.
  const auto refined = refine_rig(right_turned(*truth, turn(1, -0.5, 0.5)), *pairs(), 2);
  ASSERT_TRUE(refined) << refined.error().what;
  EXPECT_LT(true_row_error_px(refined->rig, *truth), 0.5);
  const double pan_px = std::abs(wrong_turn_deg(refined->rig, *truth).y) * kDeg * truth->left.fx_px;
  EXPECT_TRUE(pan_px < 2 || refined->after.verdict != RigVerdict::kGood) << pan_px;
}

/// A bare room whose light dims: its points make a pan of the right rig likely, and could not tell a small one from none.
TEST(SceneClip, WhatABareRoomCannotTellIsNotSaid) {
  const auto folder = data_folder() / "sequences" / "dev_hard_beige";
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << "skipped: no data";
  const auto rig = load_rig(folder / "calibration_truth.yml");
  auto source = open_pairs(folder / "left.avi", folder / "right.avi");
  ASSERT_TRUE(rig && source);
  std::vector<std::shared_ptr<const Pair>> pairs;
  for (int i = 0; i < 69; ++i) {
    auto pair = std::make_shared<Pair>();
    ASSERT_TRUE((*source)->next(*pair));
    if (i >= 50 && (i - 50) % 9 == 0) pairs.push_back(std::move(pair));
  }
  ASSERT_EQ(pairs.size(), 3u);
  const RigFit fit = rig_fit(*rig, pairs, 2);
  EXPECT_EQ(fit.verdict, RigVerdict::kGood) << fit.what;
  EXPECT_EQ(rig_fit(right_turned(*rig, turn(0.3, 0, 0)), pairs, 2).verdict, RigVerdict::kRecalibrate);
}

INSTANTIATE_TEST_SUITE_P(Rendered, SceneClips, testing::Values("dev_easy_wave", "dev_hard_beige"));

}  // namespace
}  // namespace duo
