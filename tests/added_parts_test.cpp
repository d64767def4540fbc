// A source, a tracker and a sink of a user's own, through public headers alone.
#include <gtest/gtest.h>

#include <vector>

#include "duoptic/pipeline.h"
#include "duoptic/synthetic.h"

namespace duo {
namespace {

constexpr Size kPartsSize = {160, 120};

/// One rendered moment of a room, three times.
class ThreePairs final : public PairSource {
 public:
  Size size() const override { return kPartsSize; }
  std::int64_t count() const override { return 3; }
  bool still() const override { return false; }
  std::optional<Rig> rig() const override { return scene_.rig; }
  std::string warning() const override { return {}; }
  Result<Next> next(Pair& into) override {
    if (given_ == 3) return Next::kEnd;
    into.left.pixels = scene_.pair.left.pixels.clone();
    into.right.pixels = scene_.pair.right.pixels.clone();
    into.left.t_ns = into.right.t_ns = given_ * 33'333'333;
    into.sequence = static_cast<std::uint64_t>(given_++);
    return Next::kNew;
  }

 private:
  const SyntheticPair scene_ = render_synthetic({.size = kPartsSize}, 2);
  int given_ = 0;
};

/// A "hand" at the nearest pixel of the frame.
class NearestPoint final : public Tracker {
 public:
  const char* name() const override { return "nearest point"; }
  std::span<const Skeleton* const> skeletons() const override { return kSkeletons; }
  bool starts_by_itself() const override { return true; }
  Wants wants() const override { return {.color = true}; }
  Result<void> prepare(const TrackerSetup& setup) override {
    rectified_ = setup.rectified;
    return {};
  }
  Result<std::span<const Person>> select(const Frame& frame, std::span<const Selection>) override { return track(frame); }
  std::span<const Person> track(const Frame& frame) override {
    const auto& d_q4 = frame.disparity.d_q4;
    std::uint16_t nearest = 0;
    Vec2 at_px = {};
    for (int y = 0; y < d_q4.height(); ++y)
      for (int x = 0; x < d_q4.width(); ++x)
        if (const std::uint16_t d = d_q4.at(y, x); d != Disparity::kNone && d > nearest) {
          nearest = d;
          at_px = {static_cast<double>(x), static_cast<double>(y)};
        }
    person_ = {.id = 1, .skeleton = &kRightArm};
    if (nearest > 0) {
      Joint& hand = person_.joints[*kRightArm.index_of(JointId::kRightHand)];
      hand.p_in_rig_m = rectified_.triangulate(at_px, nearest / 16.0);
      hand.state = JointState::kSeen;
    }
    person_.sum_up();
    return {&person_, 1};
  }
  void reset() override { person_ = {}; }

 private:
  static constexpr const Skeleton* kSkeletons[] = {&kRightArm};
  Rectified rectified_;
  Person person_;
};

class Keep final : public Sink {
 public:
  explicit Keep(std::vector<Person>& into) : into_(into) {}
  Result<void> write(const TrackedFrame& frame) override {
    into_.insert(into_.end(), frame.people.begin(), frame.people.end());
    return {};
  }
  Result<void> finish() override { return {}; }

 private:
  std::vector<Person>& into_;
};

TEST(AddedParts, GoTheWholeWay) {
  PipelineSetup setup;
  setup.engine = "simd";
  setup.frames.max_disparity = 48;
  auto pipeline = Pipeline::open(std::make_unique<ThreePairs>(), setup, std::make_unique<NearestPoint>());
  ASSERT_TRUE(pipeline) << pipeline.error().what;
  EXPECT_EQ(pipeline->header().tracker, "nearest point");
  std::vector<Person> kept;
  ASSERT_TRUE(pipeline->add_sink("kept", std::make_unique<Keep>(kept)));
  for (int i = 0; i < 3; ++i) {
    const auto next = pipeline->next();
    ASSERT_TRUE(next && *next == Next::kNew);
    ASSERT_TRUE(pipeline->write());
  }
  EXPECT_EQ(*pipeline->next(), Next::kEnd);
  ASSERT_TRUE(pipeline->finish_sinks());
  ASSERT_EQ(kept.size(), 3u);
  for (const Person& person : kept) {
    const Joint* hand = person.find(JointId::kRightHand);
    ASSERT_EQ(hand->state, JointState::kSeen);
    EXPECT_GT(hand->p_in_rig_m.z, pipeline->rectified()->depth_m(48));
    EXPECT_LT(hand->p_in_rig_m.z, 3) << "nothing of the room is nearer than that";
  }
}

}  // namespace
}  // namespace duo
