// The arm tracker on the rendered clips of the test data: errors, honesty, determinism, memory.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <utility>

#include "duoptic/engine.h"
#include "duoptic/source.h"
#include "duoptic/tracker.h"
#include "tests/allocations.h"

namespace duo {
namespace {

namespace fs = std::filesystem;

struct Limits {
  const char* clip;
  double hand_mm, hand_lost, elbow_lost;  // median; shares of the frames in which the joint is visible
};
std::ostream& operator<<(std::ostream& out, const Limits& l) { return out << l.clip; }

struct Truth {
  Vec3 p_in_left_m;
  ArmSelection::Click left_px;
  bool visible = false;
};
using TrueArm = std::array<Truth, kArmJoints>;

std::vector<TrueArm> read_truth(const fs::path& path) {
  std::ifstream file(path);
  const auto json = nlohmann::json::parse(file);
  const std::string side = json["meta"]["selected_arm"];
  std::vector<TrueArm> out;
  for (const auto& frame : json["frames"]) {
    TrueArm& arm = out.emplace_back();
    for (std::size_t j = 0; j < arm.size(); ++j) {
      const auto& joint = frame["joints"][side + "_" + std::string(kJointNames[j])];
      arm[j].p_in_left_m = {joint["xyz"][0], joint["xyz"][1], joint["xyz"][2]};
      arm[j].visible = joint["vis_left"] && joint["vis_right"];
      if (joint["in_left"]) arm[j].left_px = {joint["uv_left"][0], joint["uv_left"][1]};
    }
  }
  return out;
}

class Clips : public testing::TestWithParam<Limits> {
 protected:
  void SetUp() override {
    const char* data = std::getenv("DUOPTIC_DATA");
    folder_ = fs::path(data ? data : "../shared/data") / "sequences" / GetParam().clip;
    if (!fs::exists(folder_)) GTEST_SKIP() << "skipped: no data";
  }
  fs::path folder_;
};

struct Scores {
  std::vector<double> errors_m;  // over visible frames
  int lost = 0, seen = 0, within = 0;

  void add(const Keypoint& joint, Vec3 truth) {
    constexpr double kLostM = 0.1;
    const double error_m = joint.state == JointState::kLost ? 10 : norm(joint.p_in_rig_m - truth);
    errors_m.push_back(error_m);
    lost += error_m > kLostM;
    if (joint.state == JointState::kLost) return;
    ++seen;
    within += error_m < 3 * joint.sigma_m;
  }
  double median_mm() {
    std::nth_element(errors_m.begin(), errors_m.begin() + static_cast<std::ptrdiff_t>(errors_m.size() / 2), errors_m.end());
    return 1000 * errors_m[errors_m.size() / 2];
  }
  double lost_share() const { return lost / static_cast<double>(errors_m.size()); }
  double within_share() const { return within / static_cast<double>(std::max(1, seen)); }
};

// Two trackers see the same frames: the second must give the same bits. Memory is counted around the first.
TEST_P(Clips, AccurateHonestAndRepeatable) {
  const auto rig = load_rig(folder_ / "calibration_truth.yml");
  ASSERT_TRUE(rig) << rig.error().what;
  const auto truth = read_truth(folder_ / "truth.json");
  const auto pairs = open_pairs(folder_ / "left.avi", folder_ / "right.avi");
  ASSERT_TRUE(pairs) << pairs.error().what;
  const auto engine = make_engine("simd", 2);
  ASSERT_TRUE(engine);
  duo::Setup setup;
  setup.size = (*pairs)->size();
  setup.rig = *rig;
  setup.wants.color = true;
  ASSERT_TRUE((*engine)->prepare(setup));
  const Rectified geometry = *(*engine)->rectified();
  std::array<std::unique_ptr<Tracker>, 2> trackers;
  for (auto& tracker : trackers) {
    tracker = std::move(*make_tracker("arm", "default"));
    ASSERT_TRUE(tracker->prepare({*rig, geometry, 1.0 / 30}));
  }

  std::array<Scores, kArmJoints> scores;
  bool started = false;
  long allocated = 0;
  Pair pair;
  for (std::size_t n = 0; n < truth.size(); ++n) {
    const auto next = (*pairs)->next(pair);
    ASSERT_TRUE(next && *next == Next::kPicture);
    const TrueArm& arm = truth[n];
    if (!started && !std::all_of(arm.begin(), arm.end(), [](const Truth& t) { return t.visible; })) continue;
    (*engine)->submit(pair);
    const Frame& frame = (*engine)->collect();
    if (!std::exchange(started, true))
      for (auto& tracker : trackers) {
        const auto selected = tracker->select(frame, {{{arm[0].left_px, arm[1].left_px, arm[2].left_px}}});
        ASSERT_TRUE(selected) << selected.error().what;
      }
    const long before = test::allocations;
    const ArmPose& pose = trackers[0]->track(frame)[0];
    allocated += test::allocations - before;
    const ArmPose& again = trackers[1]->track(frame)[0];
    for (std::size_t j = 0; j < arm.size(); ++j) {
      ASSERT_EQ(pose.joints[j].p_in_rig_m, again.joints[j].p_in_rig_m) << n;
      ASSERT_EQ(pose.joints[j].sigma_m, again.joints[j].sigma_m) << n;
      if (arm[j].visible) scores[j].add(pose.joints[j], geometry.rig_from_left * arm[j].p_in_left_m);
    }
  }
  EXPECT_EQ(allocated, 0);

  const Limits& limits = GetParam();
  const std::array<double, kArmJoints> most_mm = {limits.hand_mm, 35, 35};
  const std::array<double, kArmJoints> most_lost = {limits.hand_lost, limits.elbow_lost, limits.hand_lost};
  for (std::size_t j = 0; j < scores.size(); ++j) {
    const double median_mm = scores[j].median_mm();
    std::printf("%s %s: median %.1f mm, lost %.1f %%, within 3 sigma %.1f %%\n", limits.clip,
                std::string(kJointNames[j]).c_str(), median_mm, 100 * scores[j].lost_share(), 100 * scores[j].within_share());
    EXPECT_LE(median_mm, most_mm[j]) << kJointNames[j];
    EXPECT_LE(scores[j].lost_share(), most_lost[j]) << kJointNames[j];
    EXPECT_GE(scores[j].within_share(), 0.95) << kJointNames[j];
  }
}

INSTANTIATE_TEST_SUITE_P(Rendered, Clips,
                         testing::Values(Limits{"dev_easy_wave", 20, 0.02, 0.02}, Limits{"dev_hard_beige", 30, 0.12, 0.25}));

}  // namespace
}  // namespace duo
