// What the arm tracker refuses, and what it says.
#include "trackers/arm/arm_tracker.h"

#include <gtest/gtest.h>

namespace duo {
namespace {

class BadInput : public testing::Test {
 protected:
  // A wall 2 m away that fills the picture but for a hole without depth at its left.
  void SetUp() override {
    const Camera camera{kSize, 300, 300, 160, 120, {}};
    setup_.rig = {camera, camera, {Mat3{}, {-0.1, 0, 0}}};
    setup_.rectified.size = kSize;
    setup_.rectified.focal_px = 300;
    setup_.rectified.cx_px = 160;
    setup_.rectified.cy_px = 120;
    setup_.rectified.baseline_m = 0.1;
    frame_.left = Image<std::uint8_t>(kSize);
    frame_.color = Image<Rgb8>(kSize);
    frame_.disparity.d_q4 = Image<std::uint16_t>(kSize);
    for (int y = 0; y < kSize.height; ++y)
      for (int x = 0; x < kSize.width; ++x) frame_.disparity.d_q4.at(y, x) = x < 80 ? Disparity::kNone : 15 * 16;
    ASSERT_TRUE(tracker_->prepare(setup_));
  }
  std::string select(ArmSelection::Click hand, ArmSelection::Click elbow, ArmSelection::Click shoulder) {
    const auto result = tracker_->select(frame_, {{{hand, elbow, shoulder}}});
    return result ? "" : result.error().what;
  }
  static constexpr Size kSize{320, 240};
  TrackerSetup setup_;
  Frame frame_;
  std::unique_ptr<Tracker> tracker_ = make_arm_tracker();
};

#define EXPECT_SAYS(text, part) EXPECT_NE(std::string(text).find(part), std::string::npos) << (text)

TEST_F(BadInput, ClicksAreNamed) {
  EXPECT_SAYS(select({-5, 100}, {150, 100}, {200, 100}), "the hand click (-5, 100) lies outside the picture of 320x240");
  EXPECT_SAYS(select({120, 100}, {150, 400}, {200, 100}), "the elbow click");
  EXPECT_SAYS(select({20, 100}, {150, 100}, {200, 100}), "no depth near the hand click");
  EXPECT_SAYS(select({120, 100}, {150, 100}, {20, 100}), "no depth near the shoulder click");
  EXPECT_SAYS(select({100, 100}, {310, 100}, {280, 100}), "elbow and hand lie 1.4");
}

TEST_F(BadInput, FrameAndArms) {
  EXPECT_SAYS(tracker_->select(frame_, {}).error().what, "0 arms");
  frame_.color = {};
  EXPECT_SAYS(select({120, 100}, {150, 100}, {200, 100}), "what the tracker wants");
}

TEST_F(BadInput, FailedSelectKeepsTheArmsAndResetForgetsThem) {
  EXPECT_TRUE(tracker_->track(frame_).empty());
  EXPECT_EQ(select({120, 100}, {150, 100}, {190, 100}), "");
  EXPECT_EQ(tracker_->track(frame_).size(), 1U);
  EXPECT_NE(select({20, 100}, {150, 100}, {200, 100}), "");
  EXPECT_EQ(tracker_->track(frame_).size(), 1U);
  EXPECT_EQ(tracker_->track(frame_)[0][Joint::kElbow].u_px > 0, true);
  tracker_->reset();
  EXPECT_TRUE(tracker_->track(frame_).empty());
}

TEST_F(BadInput, Setup) {
  setup_.frame_s = 0;
  EXPECT_SAYS(tracker_->prepare(setup_).error().what, "frame");
  setup_ = {};
  EXPECT_SAYS(tracker_->prepare(setup_).error().what, "0x0");
}

TEST(MakeTracker, NamesAndPresets) {
  EXPECT_TRUE(make_tracker("arm", "default"));
  EXPECT_SAYS(make_tracker("leg", "default").error().what, "choose one of: arm");
  EXPECT_SAYS(make_tracker("arm", "best").error().what, "choose one of: default, thesis");
}

}  // namespace
}  // namespace duo
