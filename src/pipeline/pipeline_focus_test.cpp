// Frames that are matched around the people of frames before, through the whole pipeline.
#include <gtest/gtest.h>

#include "pipeline/focus_line.h"
#include "tests/agree.h"
#include "tests/waving_clip.h"

namespace duo {
namespace {

using test::Clip, test::frames_of, test::pipeline_setup;

/// Somebody 0.7 m away who moves to the right.
class Walker final : public Tracker {
 public:
  const char* name() const override { return "walker"; }
  std::span<const Skeleton* const> skeletons() const override { return skeletons_; }
  bool starts_by_itself() const override { return true; }
  Wants wants() const override { return {}; }
  Result<void> prepare(const TrackerSetup&) override { return {}; }
  Result<std::span<const Person>> select(const Frame&, std::span<const Selection>) override { return track({}); }
  std::span<const Person> track(const Frame& frame) override {
    person_.id = 1;
    person_.skeleton = &kBody;
    person_.joints[0].state = JointState::kSeen;
    person_.joints[0].p_in_rig_m = {-0.1 + 0.01 * static_cast<double>(frame.sequence), 0, 0.7};
    return {&person_, 1};
  }
  void reset() override {}

 private:
  const Skeleton* skeletons_[1] = {&kBody};
  Person person_;
};

/// Tells what it was prepared for.
class Prepared final : public Tracker {
 public:
  explicit Prepared(double& frame_s) : frame_s_(frame_s) {}
  const char* name() const override { return "prepared"; }
  std::span<const Skeleton* const> skeletons() const override { return {}; }
  Wants wants() const override { return {}; }
  Result<void> prepare(const TrackerSetup& setup) override {
    frame_s_ = setup.frame_s;
    return {};
  }
  Result<std::span<const Person>> select(const Frame&, std::span<const Selection>) override { return track({}); }
  std::span<const Person> track(const Frame&) override { return {}; }
  void reset() override {}

 private:
  double& frame_s_;
};

// Velocities are right where frames are left out; trackers refuse a second and more.
TEST(PipelineTracker, IsToldTheTimeFromOneOfItsFramesToTheNext) {
  const double frame_s = Clip().frame_s();
  ASSERT_LT(3 * frame_s, 0.99);
  for (const auto& [every, want_s] : {std::pair{1, frame_s}, std::pair{3, 3 * frame_s}, std::pair{1000, 0.99}}) {
    PipelineSetup setup = pipeline_setup();
    setup.every = every;
    double told_s = 0;
    const auto pipeline = Pipeline::open(std::make_unique<Clip>(), std::move(setup), std::make_unique<Prepared>(told_s));
    ASSERT_TRUE(pipeline) << pipeline.error().what;
    EXPECT_DOUBLE_EQ(told_s, want_s) << every;
    EXPECT_DOUBLE_EQ(pipeline->header().frame_s, frame_s) << "the source's";
  }
}

// Which frames are matched around whom does not depend on who makes how many at once.
TEST(PipelineFocus, FollowsPeople) {
  const auto frames = [](int threads, PeopleFocus focus) {
    PipelineSetup setup = pipeline_setup(threads, true);
    setup.focus = focus;
    auto pipeline = Pipeline::open(std::make_unique<Clip>(), std::move(setup), std::make_unique<Walker>());
    EXPECT_TRUE(pipeline) << pipeline.error().what;
    EXPECT_EQ(pipeline->header().focus, focus != PeopleFocus::kOff);
    return frames_of(*pipeline);
  };
  const auto known = [](const Frame& frame) {
    int out = 0;
    for (int y = 0; y < frame.disparity.d_q4.height(); ++y)
      for (int x = 0; x < frame.disparity.d_q4.width(); ++x) out += frame.disparity.d_q4.at(y, x) != Disparity::kNone;
    return out;
  };
  const auto whole = frames(1, PeopleFocus::kOff), one = frames(1, PeopleFocus::kOn),
             three = frames(3, PeopleFocus::kWherePossible);
  ASSERT_EQ(one.size(), whole.size());
  ASSERT_EQ(three.size(), whole.size());
  for (std::size_t i = 0; i < whole.size(); ++i) {
    const bool all = i < FocusLine::kBehind || i == FocusLine::kFirstWhole;
    EXPECT_EQ(one[i]->matched.empty(), all) << i;
    EXPECT_TRUE(whole[i]->matched.empty());
    if (all)
      EXPECT_EQ(known(*one[i]), known(*whole[i])) << i;
    else
      EXPECT_LT(known(*one[i]), known(*whole[i])) << i;
    EXPECT_GT(known(*one[i]), 0) << i;
    test::expect_same<std::uint16_t>(one[i]->disparity.d_q4, three[i]->disparity.d_q4, std::to_string(i));
  }
}

TEST(PipelineFocus, RefusesWhatNeedsWholeFrames) {
  PipelineSetup setup = pipeline_setup();
  setup.focus = PeopleFocus::kOn;
  setup.tracker = "arm";
  const auto arm = Pipeline::open(std::make_unique<Clip>(), setup);
  ASSERT_FALSE(arm);
  EXPECT_NE(arm.error().what.find("the tracker arm does not follow whole people"), std::string::npos) << arm.error().what;
  setup.frames.fill = true;
  const auto filled = Pipeline::open(std::make_unique<Clip>(), setup, std::make_unique<Walker>());
  ASSERT_FALSE(filled);
  EXPECT_NE(filled.error().what.find("fill holes"), std::string::npos) << filled.error().what;
  setup.focus = PeopleFocus::kWherePossible;
  const auto possible = Pipeline::open(std::make_unique<Clip>(), setup, std::make_unique<Walker>());
  ASSERT_TRUE(possible) << possible.error().what;
  EXPECT_FALSE(possible->header().focus);
}

// All pairs that may be on their way when people are forgotten are still matched around them; the next one is not.
TEST(PipelineFocus, ForgetsPeople) {
  for (const int threads : {1, 3}) {
    PipelineSetup setup = pipeline_setup(threads, true);
    setup.focus = PeopleFocus::kOn;
    auto pipeline = Pipeline::open(std::make_unique<Clip>(), std::move(setup), std::make_unique<Walker>());
    ASSERT_TRUE(pipeline) << pipeline.error().what;
    constexpr std::uint64_t kForgotten = 5;
    for (std::uint64_t i = 0; i <= kForgotten + FocusLine::kBehind + 2; ++i) {
      ASSERT_TRUE(pipeline->next());
      const std::uint64_t n = pipeline->frame()->sequence;
      if (n == kForgotten) pipeline->forget();
      if (n > kForgotten) {
        EXPECT_EQ(pipeline->frame()->matched.empty(), n == kForgotten + FocusLine::kBehind + 1) << n;
      }
    }
  }
}

}  // namespace
}  // namespace duo
