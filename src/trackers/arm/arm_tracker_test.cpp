// What the arm tracker refuses, and what it says.
#include "trackers/arm/arm_tracker.h"

#include <gtest/gtest.h>

#include "core/lens.h"

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
  std::string select(Vec2 hand, Vec2 elbow, Vec2 shoulder) {
    return select({&kLeftArm,
                   {{JointId::kLeftHand, hand.x, hand.y},
                    {JointId::kLeftElbow, elbow.x, elbow.y},
                    {JointId::kLeftShoulder, shoulder.x, shoulder.y}}});
  }
  std::string select(const Selection& selection) {
    const auto result = tracker_->select(frame_, {&selection, 1});
    return result ? "" : result.error().what;
  }
  static constexpr Size kSize{320, 240};
  TrackerSetup setup_;
  Frame frame_;
  std::unique_ptr<Tracker> tracker_ = make_arm_tracker();
};

#define EXPECT_SAYS(text, part) EXPECT_NE(std::string(text).find(part), std::string::npos) << (text)

TEST_F(BadInput, ClicksAreNamed) {
  EXPECT_SAYS(select({-5, 100}, {150, 100}, {200, 100}), "the left_hand click (-5, 100) lies outside the picture of 320x240");
  EXPECT_SAYS(select({120, 100}, {150, 400}, {200, 100}), "the left_elbow click");
  EXPECT_SAYS(select({20, 100}, {150, 100}, {200, 100}), "no depth near the left_hand click");
  EXPECT_SAYS(select({120, 100}, {150, 100}, {20, 100}), "no depth near the left_shoulder click");
  EXPECT_SAYS(select({100, 100}, {310, 100}, {280, 100}), "elbow and hand lie 1.4");
}

TEST_F(BadInput, SkeletonsAndMissingClicks) {
  EXPECT_SAYS(select({&kBody, {}}), "another skeleton than right_arm or left_arm");
  EXPECT_SAYS(select({&kRightArm, {{JointId::kRightHand, 100, 100}, {JointId::kRightElbow, 150, 100}}}),
              "no click on the right_shoulder");
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
  const Person& person = tracker_->track(frame_)[0];
  EXPECT_EQ(person.skeleton, &kLeftArm);
  EXPECT_EQ(person.id, 1u);
  EXPECT_GT(person.find(JointId::kLeftElbow)->u_px, 0);
  tracker_->reset();
  EXPECT_TRUE(tracker_->track(frame_).empty());
}

TEST_F(BadInput, Setup) {
  setup_.frame_s = 0;
  EXPECT_SAYS(tracker_->prepare(setup_).error().what, "frame");
  setup_ = {};
  EXPECT_SAYS(tracker_->prepare(setup_).error().what, "0x0");
}

/// What select() gives is what the frame's persons are: the picture is looked at once.
TEST_F(BadInput, SelectGivesThePersons) {
  const Selection arm = {
      &kRightArm, {{JointId::kRightHand, 120, 100}, {JointId::kRightShoulder, 190, 100}, {JointId::kRightElbow, 150, 100}}};
  const auto people = tracker_->select(frame_, {&arm, 1});
  ASSERT_TRUE(people) << people.error().what;
  ASSERT_EQ(people->size(), 1U);
  EXPECT_EQ((*people)[0].presence, Presence::kSeen);
  EXPECT_NEAR((*people)[0].find(JointId::kRightHand)->u_px, 120, 1);
  EXPECT_NEAR((*people)[0].find(JointId::kRightShoulder)->u_px, 190, 1);
}

TEST(MakeTracker, Names) {
  for (const std::string& name : tracker_names()) EXPECT_EQ((*make_tracker(name))->name(), name);
  EXPECT_SAYS(make_tracker("leg").error().what, "choose one of: body, body_hands, arm, thesis");
}

}  // namespace
}  // namespace duo
