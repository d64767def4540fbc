// The body tracker on whole frames: made-up scenes without a person, a rendered one with.
#include <gtest/gtest.h>

#include <cstring>

#include "duoptic/tracker.h"
#include "tests/agree.h"
#include "tests/allocations.h"
#include "trackers/body/body_tracker.h"
#include "trackers/body/rendered_person.h"

namespace duo {
namespace {

using test::body_tracker, test::copy_of, test::kFrames, test::RenderedPerson;

std::string bytes_of(std::span<const Person> people) {
  std::string out;
  for (const Person& person : people)
    for (std::size_t j = 0; j < person.count(); ++j) {
      const Joint& joint = person.joints[j];
      for (const double value : {joint.p_in_rig_m.x, joint.p_in_rig_m.y, joint.p_in_rig_m.z, joint.cov_m2.xx, joint.cov_m2.zz,
                                 joint.u_px, joint.v_px, joint.confidence, static_cast<double>(joint.state)})
        out.append(reinterpret_cast<const char*>(&value), sizeof(value));
    }
  return out;
}

TEST(BodyTracker, FindsARenderedPersonByItself) {
  const RenderedPerson& person = RenderedPerson::get();
  const auto tracker = body_tracker(person.rig, person.rectified, 2);
  EXPECT_TRUE(tracker->starts_by_itself());
  EXPECT_FALSE(tracker->select(*person.frames[0], {}));
  double worst_m = 0;
  for (int i = 0; i < kFrames; ++i) {
    const auto people = tracker->track(*person.frames[static_cast<std::size_t>(i)]);
    ASSERT_EQ(people.size(), 1u) << i;
    EXPECT_EQ(people[0].id, 1u);
    EXPECT_EQ(people[0].skeleton, &kBody);
    if (i < kFrames / 2) continue;
    for (const SyntheticJoint& truth : person.joints[static_cast<std::size_t>(i)]) {
      if (is_finger(truth.id) || !truth.visible_left || !truth.visible_right) continue;
      const Joint* joint = people[0].find(truth.id);
      ASSERT_NE(joint, nullptr);
      const double off_m = norm(joint->p_in_rig_m - person.rectified.rig_from_left * truth.p_in_left_m);
      worst_m = std::max(worst_m, off_m);
      EXPECT_LT(off_m, 0.16) << name_of(truth.id) << " in frame " << i;
    }
  }
  EXPECT_GT(worst_m, 0);
}

/// Hands of 26 px are too small for their network.
TEST(BodyTracker, FingersOfSmallHandsAreLost) {
  const RenderedPerson& person = RenderedPerson::get();
  const auto tracker = make_body_hands_tracker();
  ASSERT_TRUE(tracker->prepare({.rig = person.rig, .rectified = person.rectified, .body_model = BodyModel::kLite}));
  for (const auto& frame : person.frames) tracker->track(*frame);
  const long before = test::allocations;
  const auto people = tracker->track(*person.frames[0]);
  EXPECT_EQ(test::allocations - before, 0);
  ASSERT_TRUE(people.size() == 1 && people[0].skeleton == &kBodyHands);
  for (std::size_t j = kBodyJointIds; j < kJointIds; ++j) EXPECT_EQ(people[0].joints[j].state, JointState::kLost) << j;
}

// Every third frame at the source's rate is every frame at a third of it.
TEST(BodyTracker, KnowsTheTimeOfFramesThatWereLeftOut) {
  constexpr double kFrame_s = 1.0 / 30;
  const RenderedPerson& person = RenderedPerson::get();
  const auto left_out = make_body_tracker(), all = make_body_tracker();
  for (const auto& [tracker, frame_s] : {std::pair(left_out.get(), kFrame_s), std::pair(all.get(), 3 * kFrame_s)})
    ASSERT_TRUE(tracker->prepare(
        {.rig = person.rig, .rectified = person.rectified, .frame_s = frame_s, .body_model = BodyModel::kLite}));
  double fastest_m_s = 0;
  for (int i = 0; i < kFrames; i += 3) {
    Frame frame = copy_of(*person.frames[static_cast<std::size_t>(i)]);
    frame.t_ns = static_cast<TimeNs>(1e9 * kFrame_s * i);
    const auto got = left_out->track(frame), want = all->track(frame);
    ASSERT_TRUE(got.size() == 1 && want.size() == 1) << i;
    for (std::size_t j = 0; j < got[0].count(); ++j) {
      EXPECT_NEAR(norm(got[0].joints[j].p_in_rig_m - want[0].joints[j].p_in_rig_m), 0, 1e-6) << i << " " << j;
      if (i == 0) continue;  // one frame shows no speed
      EXPECT_NEAR(norm(got[0].joints[j].v_in_rig_m_s - want[0].joints[j].v_in_rig_m_s), 0, 1e-5) << i << " " << j;
      fastest_m_s = std::max(fastest_m_s, norm(want[0].joints[j].v_in_rig_m_s));
    }
  }
  EXPECT_GT(fastest_m_s, 0.1);
}

/// What the first fit corrects, up to two metres per second of somebody who stands, is no speed.
TEST(BodyTracker, OneFrameShowsNoSpeed) {
  const RenderedPerson& person = RenderedPerson::get();
  const auto tracker = body_tracker(person.rig, person.rectified, 1);
  const auto people = tracker->track(*person.frames[0]);
  ASSERT_EQ(people.size(), 1U);
  for (const Joint& joint : people[0].joints) EXPECT_EQ(norm(joint.v_in_rig_m_s), 0);
}

TEST(BodyTracker, OneAndTwoThreadsGiveTheSameBits) {
  const RenderedPerson& person = RenderedPerson::get();
  const auto one = body_tracker(person.rig, person.rectified, 1), two = body_tracker(person.rig, person.rectified, 2);
  for (const auto& frame : person.frames) {
    const std::string want = bytes_of(one->track(*frame));
    EXPECT_FALSE(want.empty());
    EXPECT_EQ(bytes_of(two->track(*frame)), want);
  }
  // And again from the start, as somebody else.
  one->reset();
  two->reset();
  EXPECT_EQ(bytes_of(one->track(*person.frames[0])), bytes_of(two->track(*person.frames[0])));
  EXPECT_EQ(one->track(*person.frames[1])[0].id, 2u);
}

TEST(BodyTracker, EveryInstructionSetGivesTheSameBits) {
  const RenderedPerson& person = RenderedPerson::get();
  std::string want;
  test::each_target([&](const std::string& target) {
    if (target == "EMU128") return;  // the networks' own tests run it, slowly
    std::string got;
    const auto tracker = body_tracker(person.rig, person.rectified, 1);
    for (int i = 0; i < 2; ++i) got += bytes_of(tracker->track(*person.frames[static_cast<std::size_t>(i)]));
    EXPECT_FALSE(got.empty());
    if (want.empty()) want = got;
    EXPECT_TRUE(got == want) << target;
  });
}

TEST(BodyTracker, AllocatesNothingOnceAPersonIsTracked) {
  const RenderedPerson& person = RenderedPerson::get();
  const auto tracker = body_tracker(person.rig, person.rectified, 1);
  for (const auto& frame : person.frames) tracker->track(*frame);
  const long before = test::allocations;
  for (const auto& frame : person.frames) tracker->track(*frame);
  EXPECT_EQ(test::allocations - before, 0);
}

// The other half is not matched, or behind a wall that is 40 cm nearer.
TEST(BodyTracker, OfHalfAPersonTheOtherHalfIsNotSeen) {
  const RenderedPerson& person = RenderedPerson::get();
  for (const std::uint16_t q4 : {Disparity::kNone, std::uint16_t{345}}) {
    const auto tracker = body_tracker(person.rig, person.rectified, 1);
    int seen = 0;
    for (int i = 0; i < kFrames; ++i) {
      Frame frame = copy_of(*person.frames[static_cast<std::size_t>(i)]);
      const int cut = frame.color.width() / 2;  // about through the person's middle
      for (int y = 0; y < frame.color.height(); ++y)
        for (int x = cut; x < frame.color.width(); ++x) {
          frame.color.at(y, x) = {90, 90, 90};
          frame.disparity.d_q4.at(y, x) = q4;
        }
      for (const Person& found : tracker->track(frame))
        for (std::size_t j = 0; j < found.count(); ++j) {
          if (found.joints[j].state != JointState::kSeen) continue;
          ++seen;
          EXPECT_LT(person.rectified.project(found.joints[j].p_in_rig_m).x, cut + 20)
              << name_of(kBody.joints[j].id) << " in frame " << i << ", behind " << q4;
        }
    }
    EXPECT_GT(seen, 4 * kFrames) << q4;
  }
}

// A chair 30 cm before the person hides it from a hand's breadth above the hips down.
TEST(BodyTracker, OfWhoStandsBehindAChairNothingIsSeenOnTheChair) {
  const RenderedPerson& person = RenderedPerson::get();
  const auto tracker = body_tracker(person.rig, person.rectified, 1);
  constexpr double kNearer_m = 0.42, kOff_m = 0.1;  // than the pelvis, which is 12 cm under the skin
  constexpr int kHalf_px = 45, kAbove_px = 25;
  const auto truth_of = [&](JointId id, std::size_t i) {
    for (const SyntheticJoint& joint : person.joints[i])
      if (joint.id == id) return person.rectified.rig_from_left * joint.p_in_left_m;
    return Vec3{};
  };
  const Vec3 pelvis = truth_of(JointId::kPelvis, 0);
  const Vec2 at = person.rectified.project(pelvis);
  const Rectified& geometry = person.rectified;
  const auto q4 = static_cast<std::uint16_t>(16 * geometry.focal_px * geometry.baseline_m / (pelvis.z - kNearer_m));
  int above = 0;
  for (std::size_t i = 0; i < kFrames; ++i) {
    Frame frame = copy_of(*person.frames[i]);
    const Window chair =
        Window{static_cast<int>(at.x) - kHalf_px, static_cast<int>(at.y) - kAbove_px, 2 * kHalf_px, 400}.within(
            frame.color.size());
    for (int y = chair.y; y < chair.y_end(); ++y)
      for (int x = chair.x; x < chair.x_end(); ++x) {
        const auto grain = static_cast<std::uint8_t>((x * 7 + y * 5) % 11);
        frame.color.at(y, x) = {static_cast<std::uint8_t>(120 + grain), static_cast<std::uint8_t>(70 + grain), 40};
        frame.disparity.d_q4.at(y, x) = static_cast<std::uint16_t>(q4 + (x * 7 + y * 3) % 3 - 1);
      }
    const auto people = tracker->track(frame);
    ASSERT_EQ(people.size(), 1u) << i;
    EXPECT_EQ(people[0].id, 1u);
    for (const SyntheticJoint& joint : person.joints[i]) {
      const Joint* found = people[0].find(joint.id);
      if (found == nullptr || found->state != JointState::kSeen) continue;
      const Vec3 truth = truth_of(joint.id, i);
      const Vec2 there = geometry.project(truth);
      if (!chair.contains(static_cast<int>(there.y), static_cast<int>(there.x)))
        ++above;
      else
        EXPECT_LT(norm(found->p_in_rig_m - truth), kOff_m) << name_of(joint.id) << " in frame " << i;
    }
  }
  EXPECT_GT(above, 5 * kFrames);  // head, shoulders and elbows
}

/// A frame whose pixels come from where `from` says, with disparities so many times as large.
template <class From>
Frame composed(const Frame& source, From from) {
  Frame frame = copy_of(source);
  for (int y = 0; y < frame.color.height(); ++y)
    for (int x = 0; x < frame.color.width(); ++x) {
      const auto [from_x, from_y, nearer] = from(x, y);
      frame.color.at(y, x) = source.color.at(from_y, from_x);
      const int q4 = source.disparity.d_q4.at(from_y, from_x);
      frame.disparity.d_q4.at(y, x) = static_cast<std::uint16_t>(q4 == Disparity::kNone ? q4 : q4 * nearer);
    }
  return frame;
}
struct FromPixel {
  int x, y;
  double nearer;
};

// Somebody, who is the person's mirror image and 60 cm nearer, walks past: both keep their numbers, and of the one behind
// nothing is seen on the one before.
TEST(BodyTracker, WhoeverIsBehindSomebodyStaysBehind) {
  const RenderedPerson& person = RenderedPerson::get();
  const auto tracker = body_tracker(person.rig, person.rectified, 1);
  const int width = person.rectified.size.width;
  constexpr double kNearer = 1.45, kBetween_m = 1.65;
  constexpr int kSteps = 34, kStep_px = 7, kPersonFrom_q4 = 235;
  std::uint32_t behind = 0;
  int together = 0;
  bool back = false;
  for (int i = 0; i < kSteps; ++i) {
    const int there = i % (2 * kFrames);  // to and fro through the frames
    const Frame& source = *person.frames[static_cast<std::size_t>(there < kFrames ? there : 2 * kFrames - 1 - there)];
    const int right_px = (kSteps / 2 - i) * kStep_px;
    const Frame frame = composed(source, [&](int x, int y) {
      const int from_x = width - 1 - (x - right_px);
      if (std::abs(from_x - width / 2) > 70) return FromPixel{x, y, 1};
      const std::uint16_t q4 = source.disparity.d_q4.at(y, from_x);
      return q4 != Disparity::kNone && q4 > kPersonFrom_q4 ? FromPixel{from_x, y, kNearer} : FromPixel{x, y, 1};
    });
    const auto people = tracker->track(frame);
    ASSERT_LE(people.size(), 2u) << i;
    together += people.size() == 2;
    for (const Person& found : people) {
      EXPECT_LE(found.id, 2u) << i;
      const bool is_behind = found.find(JointId::kPelvis)->p_in_rig_m.z > kBetween_m;
      if (i == 0 && is_behind) behind = found.id;
      EXPECT_EQ(found.id == behind, is_behind) << i;
      int seen = 0;
      for (std::size_t j = 0; j < found.count(); ++j) {
        if (found.joints[j].state != JointState::kSeen) continue;
        ++seen;
        EXPECT_EQ(found.joints[j].p_in_rig_m.z > kBetween_m, is_behind) << name_of(kBody.joints[j].id) << " in frame " << i;
      }
      back = is_behind && seen > 12;
    }
  }
  EXPECT_EQ(together, kSteps);
  EXPECT_TRUE(back);
}

TEST(BodyTracker, WhoseHeadIsOutOfThePictureIsFoundByDepth) {
  const RenderedPerson& person = RenderedPerson::get();
  const auto tracker = body_tracker(person.rig, person.rectified, 1);
  const SyntheticJoint* shoulder = nullptr;
  for (const SyntheticJoint& joint : person.joints[0])
    if (joint.id == JointId::kLeftShoulder) shoulder = &joint;
  ASSERT_NE(shoulder, nullptr);
  const Vec3 truth = person.rectified.rig_from_left * shoulder->p_in_left_m;
  // The border runs through the chin, 14 cm above the shoulders.
  constexpr int kBelow_px = 20;
  const int up_px = static_cast<int>(person.rectified.project(truth).y) - kBelow_px;
  const int last = person.rectified.size.height - 1;
  for (int i = 0; i < 3; ++i) {
    const Frame frame = composed(*person.frames[0], [&](int x, int y) { return FromPixel{x, std::min(y + up_px, last), 1}; });
    const auto people = tracker->track(frame);
    ASSERT_EQ(people.size(), 1u) << i;
    const Joint& found = *people[0].find(JointId::kLeftShoulder);
    EXPECT_EQ(found.state, JointState::kSeen) << i;
    EXPECT_NEAR(found.p_in_rig_m.z, truth.z, 0.08) << i;
    EXPECT_NEAR(person.rectified.project(found.p_in_rig_m).y, kBelow_px, 16) << i;
  }
}

TEST(BodyTracker, AfterALossThePersonKeepsItsNumber) {
  const RenderedPerson& person = RenderedPerson::get();
  const auto tracker = body_tracker(person.rig, person.rectified, 1);
  for (int i = 0; i < 5; ++i) tracker->track(*person.frames[static_cast<std::size_t>(i)]);
  Frame dark = copy_of(*person.frames[5]);
  for (int y = 0; y < dark.color.height(); ++y)
    for (int x = 0; x < dark.color.width(); ++x) dark.color.at(y, x) = {};
  for (int i = 0; i < 6; ++i)
    for (const Person& hidden : tracker->track(dark)) EXPECT_EQ(hidden.presence, Presence::kHidden);
  const auto again = tracker->track(*person.frames[6]);
  ASSERT_EQ(again.size(), 1u);
  EXPECT_EQ(again[0].id, 1u);
  EXPECT_EQ(tracker->track(*person.frames[7])[0].presence, Presence::kSeen);
}

}  // namespace
}  // namespace duo
