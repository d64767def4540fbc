// The thesis's tracker on painted squares: follows them by hue, follows the light, loses what disappears.
#include "trackers/thesis/thesis_tracker.h"

#include <gtest/gtest.h>

#include "core/area.h"
#include "core/lens.h"

namespace duo {
namespace {

class ThesisTracking : public testing::Test {
 protected:
  void SetUp() override {
    const Camera camera{kSize, 300, 300, 160, 120, {}};
    TrackerSetup setup;
    setup.rig = {camera, camera, {Mat3{}, {-0.1, 0, 0}}};
    setup.rectified.size = kSize;
    setup.rectified.focal_px = 300;
    setup.rectified.cx_px = 160;
    setup.rectified.cy_px = 120;
    setup.rectified.baseline_m = 0.1;
    frame_.left = Image<std::uint8_t>(kSize);
    ASSERT_TRUE(tracker_->prepare(setup));
  }
  /// A gray wall at 3 m with a square of 15 px around each place, at 2 m.
  const Frame& paint(std::initializer_list<std::pair<Pixel, Rgb8>> squares) {
    frame_.color = Image<Rgb8>(kSize);
    frame_.disparity.d_q4 = Image<std::uint16_t>(kSize);
    for (int y = 0; y < kSize.height; ++y)
      for (int x = 0; x < kSize.width; ++x) {
        frame_.color.at(y, x) = {90, 90, 90};
        frame_.disparity.d_q4.at(y, x) = 10 * 16;
      }
    for (const auto& [at, color] : squares)
      for (int y = at.y - 7; y <= at.y + 7; ++y)
        for (int x = at.x - 7; x <= at.x + 7; ++x) {
          frame_.color.at(y, x) = color;
          frame_.disparity.d_q4.at(y, x) = 15 * 16;
        }
    return frame_;
  }
  static Selection on(Vec2 hand, Vec2 elbow, Vec2 shoulder) {
    return {&kRightArm,
            {{JointId::kRightHand, hand.x, hand.y},
             {JointId::kRightElbow, elbow.x, elbow.y},
             {JointId::kRightShoulder, shoulder.x, shoulder.y}}};
  }
  static constexpr Size kSize{320, 240};
  static constexpr Rgb8 kSkin{200, 120, 80}, kGreen{40, 160, 60}, kBlue{40, 60, 180};
  Frame frame_;
  std::unique_ptr<Tracker> tracker_ = make_thesis_tracker();
};

TEST_F(ThesisTracking, FollowsHueAndDepth) {
  const Selection clicks = on({100, 80}, {160, 100}, {220, 90});
  ASSERT_TRUE(tracker_->select(paint({{{80, 100}, kSkin}, {{100, 160}, kGreen}, {{90, 220}, kBlue}}), {&clicks, 1}));
  for (int step = 1; step <= 10; ++step) {
    // The hand moves 6 px a frame, and the light turns its hue from 13 to 28 of 256: more than the tolerance in the end.
    const Rgb8 skin{200, static_cast<std::uint8_t>(120 + 4 * step), 80};
    const Person& person =
        tracker_->track(paint({{{80 + 3 * step, 100 - 6 * step}, skin}, {{100, 160}, kGreen}, {{90, 220}, kBlue}}))[0];
    const Joint& hand = *person.find(JointId::kRightHand);
    ASSERT_EQ(hand.state, JointState::kSeen);
    ASSERT_NEAR(hand.u_px, 100 - 6 * step, 1);
    ASSERT_NEAR(hand.v_px, 80 + 3 * step, 1);
    ASSERT_NEAR(hand.p_in_rig_m.z, 2, 1e-6);
    ASSERT_NEAR(person.find(JointId::kRightShoulder)->u_px, 220, 1);
  }
}

TEST_F(ThesisTracking, LosesWhatDisappears) {
  const Selection clicks = on({100, 80}, {160, 100}, {220, 90});
  ASSERT_TRUE(tracker_->select(paint({{{80, 100}, kSkin}, {{100, 160}, kGreen}, {{90, 220}, kBlue}}), {&clicks, 1}));
  paint({{{100, 160}, kGreen}, {{90, 220}, kBlue}});
  EXPECT_EQ(tracker_->track(frame_)[0].find(JointId::kRightHand)->state, JointState::kInferred);
  for (int i = 0; i < 31; ++i) tracker_->track(frame_);
  EXPECT_EQ(tracker_->track(frame_)[0].find(JointId::kRightHand)->state, JointState::kLost);
  EXPECT_EQ(tracker_->track(frame_)[0].find(JointId::kRightElbow)->state, JointState::kSeen);
}

TEST_F(ThesisTracking, RefusesGrayAndHoles) {
  const Selection gray = on({220, 90}, {160, 100}, {20, 20});
  const auto on_wall = tracker_->select(paint({}), {&gray, 1});
  ASSERT_FALSE(on_wall);
  EXPECT_NE(on_wall.error().what.find("no colour at the right_shoulder click"), std::string::npos) << on_wall.error().what;
  paint({{{20, 20}, kSkin}});
  frame_.disparity.d_q4.at(20, 20) = Disparity::kNone;
  const auto on_hole = tracker_->select(frame_, {&gray, 1});
  ASSERT_FALSE(on_hole);
  EXPECT_NE(on_hole.error().what.find("no depth at the right_shoulder click"), std::string::npos) << on_hole.error().what;
}

}  // namespace
}  // namespace duo
