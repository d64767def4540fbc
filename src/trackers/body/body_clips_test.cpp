// The body tracker on rendered clips with exact joints, without a click: errors, joints lost, hidden joints called seen,
// honesty.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

#include "body/bone_turns.h"
#include "duoptic/evaluation.h"
#include "duoptic/pipeline.h"
#include "duoptic/source.h"
#include "duoptic/statistics.h"
#include "sinks/motion_tracks.h"
#include "tests/data.h"

namespace duo {
namespace {

namespace fs = std::filesystem;
using enum JointId;

/// Bounds leave a fifth to a third beside what was measured: a change must not lose what there is.
///
/// Units  mm: median over both sides where the joint is visible; percent of these frames, lost or off by more than 100 mm
struct BodyLimits {
  const char* clip;
  double hand_mm, elbow_mm, shoulder_mm, hip_mm, head_mm;
  double arms_bad_percent;
  int liars;  // most hidden frames of a part in which it was called seen and was off by more than 100 mm
};
std::ostream& operator<<(std::ostream& out, const BodyLimits& l) { return out << l.clip; }

struct Tally {
  std::vector<double> visible_mm;
  int visible = 0, bad = 0, hidden = 0, liars = 0, known = 0, inside = 0;

  void add(const JointTruth& truth, const Joint* joint, const Mat3& rig_from_left) {
    const bool lost = joint == nullptr || joint->state == JointState::kLost;
    const double off_mm = lost ? 0 : 1000 * norm(joint->p_in_rig_m - rig_from_left * truth.p_in_left_m);
    if (truth.visible) {
      ++visible;
      bad += lost || off_mm > kBadJoint_mm;
      if (!lost) visible_mm.push_back(off_mm);
    } else {
      ++hidden;
      liars += !lost && joint->state == JointState::kSeen && off_mm > kBadJoint_mm;
    }
    if (lost) return;
    ++known;
    inside += off_mm <= 3000 * joint->sigma_m();
  }
};

/// Persons as files have them.
struct KeepsPeople final : Sink {
  explicit KeepsPeople(std::vector<Person>& to) : to_(to) {}
  Result<void> write(const TrackedFrame& frame) override {
    to_.insert(to_.end(), frame.people.begin(), frame.people.end());
    return {};
  }
  Result<void> finish() override { return {}; }
  std::vector<Person>& to_;
};

/// The joints as files of motion give them back.
struct Rebuilt {
  std::vector<double> off_mm;            // of BVH's bones from the joints that are seen
  double most_degrees = 0;               // of VMC's turned bones from the tracker's
  double least_norm = 1, most_norm = 1;  // of VMC's quaternions
};

Rebuilt rebuild(const std::vector<Person>& persons) {
  Rebuilt out;
  MotionTrack track(kBody, "");
  for (std::size_t i = 0; i < persons.size(); ++i) track.add(i, persons[i]);
  const auto poses = track.poses(persons.size());
  std::vector<Vec3> offsets(kBodyJointIds);
  for (std::size_t j = 1; j < kBodyJointIds; ++j) offsets[j] = track.offset_m(j);
  BoneTurner avatar(kBody, BodyAxes::kLeftHanded);
  for (std::size_t i = 0; i < persons.size(); ++i) {
    const auto places = known_places(persons[i], axes_from_rig(Axes::kOpengl));
    const auto in_avatar = known_places(persons[i], {{-1, 0, 0, 0, -1, 0, 0, 0, -1}});
    const auto turns = in_avatar ? avatar.turn(*in_avatar) : std::nullopt;
    if (!places || !turns) {
      ADD_FAILURE() << "frame " << i << " has no pose";
      continue;
    }
    std::vector<Vec3> at(kBodyJointIds, poses[i].root_m);
    std::vector<Mat3> whole = poses[i].turns, whole_in_avatar = *turns;
    for (std::size_t j = 1; j < kBodyJointIds; ++j) {
      const auto parent = static_cast<std::size_t>(kBody.joints[j].parent);
      at[j] = at[parent] + whole[parent] * offsets[j];
      whole[j] = whole[parent] * whole[j];
      whole_in_avatar[j] = whole_in_avatar[parent] * whole_in_avatar[j];
      if (persons[i].joints[j].state != JointState::kSeen) continue;
      out.off_mm.push_back(1000 * norm(at[j] - (*places)[j]));
      const Vec3 bone = normalized((*in_avatar)[j] - (*in_avatar)[parent]);
      const Vec3 turned = whole_in_avatar[parent] * rest_direction(kBody.joints[j].id, BodyAxes::kLeftHanded);
      const double degrees = std::atan2(norm(cross(bone, turned)), dot(bone, turned)) * 180 / std::numbers::pi;
      out.most_degrees = std::max(out.most_degrees, degrees);
      const auto q = quaternion((*turns)[j]);
      const double length = std::sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
      out.least_norm = std::min(out.least_norm, length);
      out.most_norm = std::max(out.most_norm, length);
    }
  }
  return out;
}

Result<Pipeline> open_clip(const fs::path& folder, const Rig& rig, const char* tracker, BodyModel model) {
  DUO_TRY_ASSIGN(auto pairs, open_pairs(folder / "left.avi", folder / "right.avi"));
  PipelineSetup setup;
  setup.engine = "simd";
  setup.threads = 2;
  setup.frames.rig = rig;
  setup.tracker = tracker;
  setup.body_model = model;
  return Pipeline::open(std::move(pairs), std::move(setup));
}

class BodyClips : public testing::TestWithParam<BodyLimits> {};

TEST_P(BodyClips, WithoutAClick) {
  const fs::path folder = test::data_folder() / "sequences" / GetParam().clip;
  if (!fs::exists(folder)) GTEST_SKIP() << "skipped: no data";
  const auto truth = load_clip(folder);
  ASSERT_TRUE(truth) << truth.error().what;
  auto pipeline = open_clip(folder, truth->rig, "body", BodyModel::kFull);
  ASSERT_TRUE(pipeline) << pipeline.error().what;
  const Mat3 rig_from_left = pipeline->header().rectified.rig_from_left;
  std::map<std::string_view, Tally> tallies;  // by the part, both sides
  std::vector<Person> in_file, at_once;
  ASSERT_TRUE(pipeline->add_sink("people", std::make_unique<KeepsPeople>(in_file)));
  for (const FrameTruth& frame : truth->frames) {
    const auto next = pipeline->next();
    ASSERT_TRUE(next && *next == Next::kNew);
    ASSERT_EQ(pipeline->people().size(), 1u) << "frame " << pipeline->tracked().number;
    const Person& person = pipeline->people()[0];
    EXPECT_EQ(person.id, 1u);
    at_once.push_back(person);
    ASSERT_TRUE(pipeline->write());
    for (std::size_t j = 0; j < kBodyJointIds; ++j)
      if (frame[j])
        tallies[part_of(static_cast<JointId>(j))].add(*frame[j], person.find(static_cast<JointId>(j)), rig_from_left);
  }
  const BodyLimits& limits = GetParam();
  const auto expect = [&](const char* part, double most_mm) { EXPECT_LT(median(tallies[part].visible_mm), most_mm) << part; };
  expect("hand", limits.hand_mm);
  expect("elbow", limits.elbow_mm);
  expect("shoulder", limits.shoulder_mm);
  expect("hip", limits.hip_mm);
  expect("head", limits.head_mm);
  int known = 0, inside = 0;
  for (const auto& [part, t] : tallies) {
    EXPECT_LE(t.liars, limits.liars) << part << ", hidden in " << t.hidden << " frames";
    known += t.known;
    inside += t.inside;
  }
  EXPECT_GE(inside, 0.97 * known);
  for (const char* part : {"hand", "wrist", "elbow", "shoulder"})
    EXPECT_LE(tallies[part].bad, limits.arms_bad_percent / 100 * tallies[part].visible) << part;
  ASSERT_TRUE(pipeline->finish_sinks());
  ASSERT_EQ(in_file.size(), truth->frames.size());
  Rebuilt bvh = rebuild(in_file);
  EXPECT_LT(quantile(bvh.off_mm, 1), 5);
  for (const Rebuilt& vmc : {bvh, rebuild(at_once)}) {  // it is sent at once
    EXPECT_LT(vmc.most_degrees, 1);
    EXPECT_NEAR(vmc.least_norm, 1, 1e-9);
    EXPECT_NEAR(vmc.most_norm, 1, 1e-9);
  }
}

/// The truth has no fingers, but the palm's centre lies 65 % of the way from the wrist to the middle finger's root: that root
/// is scored.
TEST(BodyHands, TheMiddleFingersRootIsWhereThePalmSays) {
  const fs::path folder = test::data_folder() / "sequences" / "dev_easy_wave";
  if (!fs::exists(folder)) GTEST_SKIP() << "skipped: no data";
  const auto truth = load_clip(folder);
  ASSERT_TRUE(truth) << truth.error().what;
  auto pipeline = open_clip(folder, truth->rig, "body_hands", BodyModel::kLite);
  ASSERT_TRUE(pipeline) << pipeline.error().what;
  const Mat3 rig_from_left = pipeline->header().rectified.rig_from_left;
  std::vector<double> off_mm;
  int frames = 0, inside = 0, pinches = 0;
  for (const FrameTruth& frame : truth->frames) {
    if (++frames > 40) break;
    const auto next = pipeline->next();
    ASSERT_TRUE(next && *next == Next::kNew);
    ASSERT_EQ(pipeline->people().size(), 1u);
    const Person& person = pipeline->people()[0];
    pinches += pinch_of(person, Side::kRight).has_value();
    const Joint& root = *person.find(kRightMiddleMcp);
    if (root.state == JointState::kLost) continue;
    const Vec3 wrist = frame[static_cast<std::size_t>(kRightWrist)]->p_in_left_m,
               palm = frame[static_cast<std::size_t>(kRightHand)]->p_in_left_m;
    off_mm.push_back(1000 * norm(root.p_in_rig_m - rig_from_left * (wrist + (1 / 0.65) * (palm - wrist))));
    inside += off_mm.back() <= 3000 * root.sigma_m();
  }
  ASSERT_GE(off_mm.size(), 25u);
  EXPECT_LT(median(off_mm), 25);
  EXPECT_GE(inside, 0.95 * static_cast<double>(off_mm.size()));
  EXPECT_GE(pinches, 20);
}

INSTANTIATE_TEST_SUITE_P(Rendered, BodyClips,
                         testing::Values(BodyLimits{"dev_easy_wave", 17, 22, 20, 48, 22, 0.5, 1},
                                         BodyLimits{"dev_hard_beige", 18, 28, 22, 42, 20, 1.5, 2},
                                         BodyLimits{"dev_full_turn", 25, 36, 30, 30, 26, 4.5, 2}),
                         [](const auto& info) { return std::string(info.param.clip); });

}  // namespace
}  // namespace duo
