// The body tracker on rendered clips with exact joints, without a click: errors, joints lost, hidden joints called seen,
// honesty.
#include <gtest/gtest.h>

#include <algorithm>
#include <map>

#include "duoptic/evaluation.h"
#include "duoptic/pipeline.h"
#include "duoptic/source.h"
#include "duoptic/statistics.h"
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

class BodyClips : public testing::TestWithParam<BodyLimits> {};

TEST_P(BodyClips, WithoutAClick) {
  const fs::path folder = test::data_folder() / "sequences" / GetParam().clip;
  if (!fs::exists(folder)) GTEST_SKIP() << "skipped: no data";
  const auto truth = load_clip(folder);
  ASSERT_TRUE(truth) << truth.error().what;
  auto pairs = open_pairs(folder / "left.avi", folder / "right.avi");
  ASSERT_TRUE(pairs) << pairs.error().what;
  PipelineSetup setup;
  setup.engine = "simd";
  setup.threads = 2;
  setup.frames.rig = truth->rig;
  setup.tracker = "body";
  setup.body_model = BodyModel::kFull;
  auto pipeline = Pipeline::open(std::move(*pairs), std::move(setup));
  ASSERT_TRUE(pipeline) << pipeline.error().what;
  const Mat3 rig_from_left = pipeline->header().rectified.rig_from_left;
  std::map<std::string_view, Tally> tallies;  // by the part, both sides
  for (const FrameTruth& frame : truth->frames) {
    const auto next = pipeline->next();
    ASSERT_TRUE(next && *next == Next::kNew);
    ASSERT_EQ(pipeline->people().size(), 1u) << "frame " << pipeline->tracked().number;
    const Person& person = pipeline->people()[0];
    EXPECT_EQ(person.id, 1u);
    for (std::size_t j = 0; j < kJointIds; ++j)
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
}

INSTANTIATE_TEST_SUITE_P(Rendered, BodyClips,
                         testing::Values(BodyLimits{"dev_easy_wave", 17, 22, 20, 48, 22, 0.5, 1},
                                         BodyLimits{"dev_hard_beige", 18, 28, 22, 42, 20, 1.5, 2},
                                         BodyLimits{"dev_full_turn", 25, 36, 30, 30, 26, 4.5, 4}),
                         [](const auto& info) { return std::string(info.param.clip); });

}  // namespace
}  // namespace duo
