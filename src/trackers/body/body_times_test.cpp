// What the tracker body does between frames goes by time, not by how many frames there are.
#include <gtest/gtest.h>

#include "trackers/body/joints.h"
#include "trackers/body/rendered_person.h"

namespace duo {
namespace {

using test::body_tracker, test::copy_of, test::RenderedPerson;

constexpr int kWalked = 6;  // frames
constexpr double kFrame_s = 1.0 / 30;

/// The person walks 4 px a frame to the right of the picture.
Frame walking_frame(int i, double t_s) {
  constexpr int kStep_px = 4;
  const Frame& source = *RenderedPerson::get().frames[static_cast<std::size_t>(i)];
  Frame out = copy_of(source);
  for (int y = 0; y < out.color.height(); ++y)
    for (int x = 0; x < out.color.width(); ++x) {
      const int from_x = std::max(x - kStep_px * i, 0);
      out.color.at(y, x) = source.color.at(y, from_x);
      out.disparity.d_q4.at(y, x) = source.disparity.d_q4.at(y, from_x);
    }
  out.t_ns = static_cast<TimeNs>(std::llround(1e9 * t_s));
  return out;
}

Frame dark_frame_at(double t_s) {
  Frame out = walking_frame(0, t_s);
  for (int y = 0; y < out.color.height(); ++y)
    for (int x = 0; x < out.color.width(); ++x) out.color.at(y, x) = {};
  return out;
}

/// The person in the last frame that shows it, and in the dark frames after it.
struct Missed {
  Person before, after;
};

/// So many dark frames follow; `gap`: from one to the next, in frames of the source.
Missed missed(double frame_s, int dark_frames, int gap) {
  const RenderedPerson& person = RenderedPerson::get();
  const auto tracker = make_body_tracker();
  EXPECT_TRUE(
      tracker->prepare({.rig = person.rig, .rectified = person.rectified, .frame_s = frame_s, .body_model = BodyModel::kLite}));
  Missed out;
  for (int i = 0; i < kWalked; ++i) {
    const auto people = tracker->track(walking_frame(i, frame_s * i));
    EXPECT_EQ(people.size(), 1u);
    if (!people.empty()) out.before = people[0];
  }
  for (int i = 1; i <= dark_frames; ++i) {
    const auto people = tracker->track(dark_frame_at(frame_s * (kWalked - 1 + gap * i)));
    EXPECT_EQ(people.size(), 1u);
    if (!people.empty()) out.after = people[0];
  }
  return out;
}

/// How far the whole person went.
Vec3 way_of(const Missed& person) {
  const Vec3 way = person.after.joints[0].p_in_rig_m - person.before.joints[0].p_in_rig_m;
  for (std::size_t j = 0; j < person.before.count(); ++j)
    EXPECT_NEAR(norm(person.after.joints[j].p_in_rig_m - person.before.joints[j].p_in_rig_m - way), 0, 1e-9) << j;
  return way;
}

// Who is missed walks on: in a frame that comes three times as late three times as far, at the same speed; at most 20 cm.
TEST(BodyTimes, WhoIsMissedWalksOnByTheTimeOfFramesThatWereLeftOut) {
  const Missed next = missed(kFrame_s, 1, 1), third = missed(kFrame_s, 1, 3), late = missed(kFrame_s, 1, 15);
  const Missed half = missed(kFrame_s / 2, 1, 1);
  const Vec3 step = way_of(next);
  EXPECT_GT(step.x, 0.01);
  EXPECT_NEAR(norm(way_of(third) - 3 * step), 0, 1e-9);
  EXPECT_NEAR(norm(way_of(late) - (0.2 / norm(step)) * step), 0, 1e-9);
  for (std::size_t j = 0; j < next.after.count(); ++j) {
    // Of its pace 0.8 are left after one tick, 0.8^3 after three and 1 - 0.2 / 2 after half of one.
    EXPECT_NEAR(norm(next.after.joints[j].v_in_rig_m_s - (0.8 / kFrame_s) * step), 0, 1e-9) << j;
    EXPECT_NEAR(norm(third.after.joints[j].v_in_rig_m_s - (0.512 / kFrame_s) * step), 0, 1e-9) << j;
    EXPECT_NEAR(norm(half.after.joints[j].v_in_rig_m_s - (0.9 / (kFrame_s / 2)) * way_of(half)), 0, 1e-9) << j;
  }
}

// By hand, after six ticks: 35 mm + 250 mm/s * 0.2 s = 85 mm, which the scale of 1.4 for all that is wrong in every frame alike
// stretches.
TEST(BodyTimes, TheDoubtOfWhoIsMissedGrowsWithTime) {
  const double want_m2 = body::square(1.4 * 0.085);
  for (const auto& [frame_s, frames, gap] :
       {std::tuple{1.0 / 30, 6, 1}, {1.0 / 60, 12, 1}, {1.0 / 30, 1, 6}, {1.0 / 30, 2, 3}}) {
    const Missed person = missed(frame_s, frames, gap);
    int checked = 0;
    for (const JointId id : body::kFreeJoints) {
      const Joint &before = *person.before.find(id), &after = *person.after.find(id);
      if (before.state != JointState::kSeen || body::is_hand_or_wrist(id)) continue;
      ++checked;
      EXPECT_NEAR(after.cov_m2.xx - before.cov_m2.xx, want_m2, 1e-9) << name_of(id) << " " << frame_s << " " << gap;
      EXPECT_NEAR(after.cov_m2.zz - before.cov_m2.zz, want_m2, 1e-9) << name_of(id) << " " << frame_s << " " << gap;
    }
    EXPECT_GT(checked, 4);
  }
}

// By hand: 0.9 * 0.9; half of a tenth is lost in half a tick. A gain of a half and of a half of what is left; a half of a half.
TEST(BodyTimes, SharesAndGainsGoByTicks) {
  EXPECT_DOUBLE_EQ(body::ticks_in(0.0333333333), 1);
  EXPECT_DOUBLE_EQ(body::ticks_in(1e-6), 1.0 / 64);  // no frame takes no time
  EXPECT_DOUBLE_EQ(body::left_after(1, 0.9), 0.9);
  EXPECT_DOUBLE_EQ(body::left_after(2, 0.9), 0.81);
  EXPECT_DOUBLE_EQ(body::left_after(0.5, 0.9), 0.95);
  EXPECT_DOUBLE_EQ(body::gain_over(1, 0.5), 0.5);
  EXPECT_DOUBLE_EQ(body::gain_over(2, 0.5), 0.75);
  EXPECT_DOUBLE_EQ(body::gain_over(0.5, 0.5), 0.25);
  EXPECT_EQ(body::ticks_in(33333333e-9), 1);
  EXPECT_EQ(body::ticks_in(16666667e-9), 0.5);
  EXPECT_EQ(body::ticks_in(1001.0 / 15000), 2);
}

/// In how many frames a wrist shows, after twelve ticks without depth, until it is called seen. Its hand is too small for its
/// network.
int frames_until_seen(double frame_s) {
  constexpr int kMost = 30, kHidden_px = 14;
  constexpr double kBefore_s = 0.2, kHidden_s = 0.4;
  const RenderedPerson& person = RenderedPerson::get();
  const auto tracker = make_body_tracker();
  EXPECT_TRUE(
      tracker->prepare({.rig = person.rig, .rectified = person.rectified, .frame_s = frame_s, .body_model = BodyModel::kLite}));
  Frame shown = copy_of(*person.frames[0]), hidden = copy_of(*person.frames[0]);
  for (const SyntheticJoint& joint : person.joints[0])
    if (joint.id == JointId::kRightWrist || joint.id == JointId::kRightHand) {
      const Vec2 at = person.rectified.project(person.rectified.rig_from_left * joint.p_in_left_m);
      for (int y = -kHidden_px; y <= kHidden_px; ++y)
        for (int x = -kHidden_px; x <= kHidden_px; ++x) {
          const int to_x = static_cast<int>(at.x) + x, to_y = static_cast<int>(at.y) + y;
          if (to_x >= 0 && to_y >= 0 && to_x < hidden.color.width() && to_y < hidden.color.height())
            hidden.disparity.d_q4.at(to_y, to_x) = Disparity::kNone;
        }
    }
  int before = static_cast<int>(std::lround(kBefore_s / frame_s)), between = static_cast<int>(std::lround(kHidden_s / frame_s));
  for (int i = 0; i < before + between + kMost; ++i) {
    Frame& frame = i >= before && i < before + between ? hidden : shown;
    frame.t_ns = static_cast<TimeNs>(std::llround(1e9 * frame_s * i));
    const auto people = tracker->track(frame);
    if (people.size() != 1) return -1;
    const bool seen = people[0].find(JointId::kRightWrist)->state == JointState::kSeen;
    if (i == before - 1 && !seen) return -2;
    if (i == before + between - 1 && seen) return -3;
    if (i >= before + between && seen) return i - before - between + 1;
  }
  return kMost;
}

// Five ticks after the first frame that shows it, of which there are ten, five, or three.
TEST(BodyTimes, AHandThatNoNetworkSawIsBelievedByTime) {
  EXPECT_EQ(frames_until_seen(1.0 / 60), 11);
  EXPECT_EQ(frames_until_seen(1.0 / 30), 6);
  EXPECT_EQ(frames_until_seen(1.0 / 15), 4);
}

// Half a second after it was seen last somebody new is forgotten.
TEST(BodyTimes, SomebodyNewIsForgottenByTime) {
  const RenderedPerson& person = RenderedPerson::get();
  const auto tracker = body_tracker(person.rig, person.rectified, 1);
  ASSERT_EQ(tracker->track(walking_frame(0, 0)).size(), 1u);
  EXPECT_EQ(tracker->track(dark_frame_at(0.5)).size(), 1u);
  EXPECT_TRUE(tracker->track(dark_frame_at(0.6)).empty());
}

}  // namespace
}  // namespace duo
