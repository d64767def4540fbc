// What a scene says of a rig: on our own rendered room, whose rig is known.
#include "duoptic/rig_health.h"

#include <gtest/gtest.h>

#include <cmath>

#include "duoptic/synthetic.h"
#include "tests/turned_rig.h"

namespace duo {
namespace {

using namespace test;

/// Pictures in memory as a stream.
class Pairs : public PairSource {
 public:
  Pairs(const Image<Rgb8>& left, const Image<Rgb8>& right) : left_(left), right_(right) {}
  Size size() const override { return left_.size(); }
  std::int64_t count() const override { return 1; }
  bool still() const override { return true; }
  Result<Next> next(Pair& into) override {
    if (given_) return Next::kEnd;
    given_ = true;
    into.left.pixels = left_.clone();
    into.right.pixels = right_.clone();
    return Next::kNew;
  }
  std::string warning() const override { return {}; }

 private:
  const Image<Rgb8>&left_, &right_;
  bool given_ = false;
};

void expect_error(const Error& error, const std::string& part) {
  EXPECT_NE(error.what.find(part), std::string::npos) << error.what;
  EXPECT_EQ(error.what.find('\n'), std::string::npos) << error.what;
}

/// The room, rendered once for all tests.
class Room : public testing::Test {
 protected:
  static void SetUpTestSuite() { room_ = new SyntheticPair(render_synthetic({.size = {480, 360}}, 2)); }
  static void TearDownTestSuite() {
    delete room_;
    room_ = nullptr;
  }
  static const Rig& truth() { return room_->rig; }
  static Pairs pairs() { return {room_->pair.left.pixels, room_->pair.right.pixels}; }
  static Pairs same_picture() { return {room_->pair.left.pixels, room_->pair.left.pixels}; }
  static Pairs swapped_pairs() { return {room_->pair.right.pixels, room_->pair.left.pixels}; }

 private:
  inline static SyntheticPair* room_ = nullptr;
};

TEST_F(Room, TheTrueRigIsGood) {
  Pairs stream = pairs();
  const auto health = scene_health(truth(), stream, 2);
  ASSERT_TRUE(health) << health.error().what;
  EXPECT_EQ(health->verdict, RigVerdict::kGood);
  EXPECT_LT(health->row_px, 0.1);
  EXPECT_GT(health->points, 150);
  EXPECT_GT(health->covered, 0.5);
  EXPECT_LT(std::abs(health->turned_rad.x), 0.05 * kDeg);
  EXPECT_LT(std::abs(health->turned_rad.z), 0.05 * kDeg);
  EXPECT_LT(std::abs(health->turned_rad.y), 4 * health->turned_sigma_rad.y);
  EXPECT_TRUE(rig_doubts(truth()).empty());

  Pairs again = pairs();
  const auto one_thread = scene_health(truth(), again, 1);
  ASSERT_TRUE(one_thread);
  EXPECT_EQ(one_thread->row_px, health->row_px);
  EXPECT_EQ(one_thread->turned_rad, health->turned_rad);
}

TEST_F(Room, ATurnedCameraIsSeenAndPutRight) {
  const Rig nudged[] = {right_turned(truth(), turn(1, 0, 0)),       right_turned(truth(), turn(0, 0, 1)),
                        left_turned(truth(), turn(0, 0, -1)),       right_turned(truth(), turn(0, 1, 0)),
                        left_turned(truth(), turn(0.6, -0.6, 0.5)), right_turned(truth(), turn(0.7, 0, -0.7))};
  for (const Rig& rig : nudged) {
    SCOPED_TRACE(&rig - nudged);
    Pairs stream = pairs();
    const auto refined = refine_rig(rig, stream, 2);
    ASSERT_TRUE(refined) << refined.error().what;
    EXPECT_EQ(refined->before.verdict, RigVerdict::kRecalibrate);
    EXPECT_EQ(refined->after.verdict, RigVerdict::kGood);
    EXPECT_LT(true_row_error_px(refined->rig, truth()), 0.5);
    const Vec3 left = wrong_turn_deg(refined->rig, truth());
    EXPECT_LT(std::max(std::abs(left.x), std::abs(left.z)), 0.05);
    EXPECT_NEAR(refined->rig.baseline_m(), truth().baseline_m(), 1e-12);
    EXPECT_EQ(refined->rig.left, truth().left);
  }
}

// A pan that the scene is not sure of stays as the calibration had it.
TEST_F(Room, PanStaysWhereTheSceneDoesNotInsist) {
  Pairs stream = pairs();
  const auto refined = refine_rig(right_turned(truth(), turn(0.5, 0, 0.5)), stream, 2);
  ASSERT_TRUE(refined);
  EXPECT_LT(std::abs(wrong_turn_deg(refined->rig, truth()).y), 0.02);
}

TEST_F(Room, AGoodRigIsLeftAsItIs) {
  Pairs stream = pairs();
  const auto refined = refine_rig(truth(), stream, 2);
  ASSERT_TRUE(refined);
  EXPECT_EQ(refined->rig.right_from_left, truth().right_from_left);
}

TEST_F(Room, FromSceneWithIntrinsics) {
  Rig lenses = truth();
  lenses.right_from_left = {{}, {-1, 0, 0}};  // must not matter
  Pairs stream = pairs();
  const auto found = rig_from_scene(lenses, truth().baseline_m(), stream, 2);
  ASSERT_TRUE(found) << found.error().what;
  EXPECT_TRUE(found->rig.metric);
  EXPECT_EQ(found->after.verdict, RigVerdict::kGood);
  EXPECT_LT(true_row_error_px(found->rig, truth()), 0.5);
  const Vec3 wrong = wrong_turn_deg(found->rig, truth());
  EXPECT_LT(std::max(std::abs(wrong.x), std::abs(wrong.z)), 0.05);
  EXPECT_LT(std::abs(wrong.y), 0.2);
  EXPECT_NEAR(found->rig.baseline_m(), truth().baseline_m(), 1e-12);
}

TEST_F(Room, FromSceneWithoutIntrinsicsIsNotMetric) {
  Pairs stream = pairs();
  const auto found = rig_from_scene({}, 0.1, stream, 2);
  ASSERT_TRUE(found) << found.error().what;
  EXPECT_FALSE(found->rig.metric);
  EXPECT_NE(found->after.verdict, RigVerdict::kRecalibrate);
  EXPECT_LT(true_row_error_px(found->rig, truth()), 1);
  ASSERT_FALSE(rig_doubts(found->rig).empty());
}

TEST_F(Room, SaysWhatIsWrongWithThePictures) {
  Pairs other_way = swapped_pairs();
  const auto swapped = scene_health(truth(), other_way, 2);
  ASSERT_FALSE(swapped);
  expect_error(swapped.error(), "left and right are swapped");
  Pairs other_way_again = swapped_pairs();
  const auto no_lenses = rig_from_scene({}, 0.1, other_way_again, 2);
  ASSERT_FALSE(no_lenses);
  expect_error(no_lenses.error(), "left and right are swapped");

  Pairs one_camera = same_picture();
  const auto same = scene_health(truth(), one_camera, 2);
  ASSERT_FALSE(same);
  expect_error(same.error(), "the same picture");

  const Image<Rgb8> blank({480, 360});
  Pairs nothing(blank, blank);
  const auto empty = scene_health(truth(), nothing, 2);
  ASSERT_FALSE(empty);
  expect_error(empty.error(), "only 0 points in common");

  Pairs stream = pairs();
  const auto other_size = scene_health(synthetic_rig({.size = {640, 480}}), stream, 2);
  ASSERT_FALSE(other_size);
  expect_error(other_size.error(), "640x480, these have 480x360, the same scaled by 0.75");
}

TEST(RigDoubts, NamesWhatNoWebcamHas) {
  const Rig good = synthetic_rig({.size = {640, 480}});
  const auto expect_doubt = [&](auto change, RigVerdict verdict, const std::string& part) {
    Rig rig = good;
    change(rig);
    const auto doubts = rig_doubts(rig);
    ASSERT_FALSE(doubts.empty()) << part;
    EXPECT_EQ(doubts[0].verdict, verdict) << part;
    EXPECT_NE(doubts[0].what.find(part), std::string::npos) << doubts[0].what;
  };
  expect_doubt([](Rig& r) { r.left.distortion = {-0.6, 0, 0, 0, 0, 0, 0, 0}; }, RigVerdict::kRecalibrate,
               "left distortion turns back inside the picture");
  expect_doubt([](Rig& r) { r.left.fx_px = r.left.fy_px = 3000; }, RigVerdict::kCanBeImproved, "field of view");
  expect_doubt([](Rig& r) { r.right.fy_px *= 1.2; }, RigVerdict::kCanBeImproved, "right pixels would not be square");
  expect_doubt([](Rig& r) { r.right.cx_px += 150; }, RigVerdict::kCanBeImproved, "right principal point is 1");
  const auto scaled = [](double x, double y) {
    return [x, y](Rig& r) {
      for (Camera* c : {&r.left, &r.right}) c->fx_px *= x, c->cx_px *= x, c->fy_px *= y, c->cy_px *= y;
    };
  };
  expect_doubt(scaled(2, 2), RigVerdict::kRecalibrate, "in the middle of about 1280x960, not of 640x480");
  expect_doubt(scaled(0.5, 0.5), RigVerdict::kRecalibrate, "in the middle of about 320x240, not of 640x480");
  expect_doubt(scaled(2, 1.5), RigVerdict::kRecalibrate, "in the middle of about 1280x720, not of 640x480");
  expect_doubt([](Rig& r) { r.right.fx_px *= 1.2, r.right.fy_px *= 1.2; }, RigVerdict::kCanBeImproved, "focal lengths differ");
  expect_doubt([](Rig& r) { r.right_from_left.rotation = turn(0, 180, 0); }, RigVerdict::kRecalibrate, "mirrored");
  expect_doubt([](Rig& r) { r.right_from_left.rotation = turn(180, 0, 0); }, RigVerdict::kRecalibrate, "mirrored");
  expect_doubt([](Rig& r) { r.right_from_left.rotation = turn(0, 80, 0); }, RigVerdict::kRecalibrate, "no common view");
  expect_doubt([](Rig& r) { r.right_from_left.rotation = turn(0, 25, 0); }, RigVerdict::kCanBeImproved, "25 degrees apart");
  expect_doubt([](Rig& r) { r.right_from_left.t_m = {-0.1, 0.05, 0}; }, RigVerdict::kCanBeImproved, "above or before");
  expect_doubt([](Rig& r) { r.right_from_left.t_m = {-4.8, 0.05, 0}; }, RigVerdict::kCanBeImproved, "in squares of the board");
  expect_doubt([](Rig& r) { r.reprojection_rms_px = 0.9; }, RigVerdict::kCanBeImproved, "fitted to 0.90 px");
  expect_doubt([](Rig& r) { r.reprojection_rms_px = 2.3; }, RigVerdict::kRecalibrate, "fitted to 2.30 px");
}

}  // namespace
}  // namespace duo
