#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <random>

#include "core/clock.h"
#include "duoptic/evaluation.h"

namespace duo {
namespace {

/// A click on each joint, moved by `jitter_px` in a direction of its own, the same in every run; the ends of limbs come first.
Selection clicks(const Skeleton& skeleton, const FrameTruth& truth, double jitter_px, std::mt19937& random) {
  Selection selection{&skeleton, {}};
  for (std::size_t j = skeleton.joints.size(); j-- > 0;) {
    const JointTruth& joint = *truth[static_cast<std::size_t>(skeleton.joints[j].id)];
    const double angle_rad = 2 * std::numbers::pi * static_cast<double>(random()) / 4294967296.0;
    selection.clicks.push_back(
        {skeleton.joints[j].id, joint.u_px + jitter_px * std::cos(angle_rad), joint.v_px + jitter_px * std::sin(angle_rad)});
  }
  return selection;
}

double off_m(const JointTruth& truth, const Joint& joint, const Mat3& rig_from_left) {
  return norm(joint.p_in_rig_m - rig_from_left * truth.p_in_left_m);
}

/// Mean distance of a person's joints from the true ones; infinite without a common joint.
double mean_off_m(const FrameTruth& truth, const Person& person, const Mat3& rig_from_left) {
  double sum = 0;
  int count = 0;
  for (std::size_t j = 0; j < kJointIds; ++j)
    if (const Joint* joint = person.find(static_cast<JointId>(j)); joint != nullptr && truth[j]) {
      sum += off_m(*truth[j], *joint, rig_from_left);
      ++count;
    }
  return count > 0 ? sum / count : std::numeric_limits<double>::infinity();
}

/// A joint that nobody has is lost. Of several people that have it, the one nearest to the true person counts.
JointSample sample(const FrameTruth& frame, JointId id, std::span<const Person> people, const Mat3& rig_from_left) {
  const JointTruth& truth = *frame[static_cast<std::size_t>(id)];
  JointSample out{truth.visible, JointState::kLost, 0, 0, truth.in_picture};
  double least_m = std::numeric_limits<double>::infinity();
  for (const Person& person : people) {
    const Joint* found = person.find(id);
    if (found == nullptr) continue;
    const double mean_m = people.size() > 1 ? mean_off_m(frame, person, rig_from_left) : 0;
    if (mean_m >= least_m) continue;
    least_m = mean_m;
    out = {truth.visible, found->state, 1000 * off_m(truth, *found, rig_from_left), 1000 * found->sigma_m(), truth.in_picture};
  }
  return out;
}

/// Counts how often a true person is tracked under another id than before.
class Identities {
 public:
  void add(std::size_t person, const FrameTruth& truth, std::span<const Person> people, const Mat3& rig_from_left) {
    constexpr double kThere_m = 0.4;  // mean over the joints
    last_.resize(std::max(last_.size(), person + 1));
    double least_m = kThere_m;
    std::uint32_t id = 0;
    for (const Person& found : people)
      if (const double mean_m = mean_off_m(truth, found, rig_from_left); mean_m < least_m) least_m = mean_m, id = found.id;
    if (id == 0) return;
    if (last_[person] != 0 && last_[person] != id) ++switches_;
    last_[person] = id;
  }
  int switches() const { return switches_; }

 private:
  std::vector<std::uint32_t> last_;  // 0: not yet found
  int switches_ = 0;
};

/// What is scored, and whose joints have to be clicked for it.
struct Wanted {
  std::vector<JointId> joints, clicked;
  std::vector<const Skeleton*> skeletons;
};

Result<Wanted> wanted(const Tracker& tracker, const ClipTruth& truth, std::vector<JointId> joints) {
  const auto add = [](const Skeleton& skeleton, std::vector<JointId>& to) {
    for (std::size_t j = skeleton.joints.size(); j-- > 0;) to.push_back(skeleton.joints[j].id);
  };
  if (joints.empty()) {
    for (const Skeleton* skeleton : tracker.skeletons())
      if (tracker.starts_by_itself() || skeleton->joints[0].side == truth.arm) add(*skeleton, joints);
    if (tracker.starts_by_itself())  // whole bodies: the joints that the truth has
      std::erase_if(joints, [&](JointId joint) {
        return std::ranges::none_of(
            truth.frames, [&](const FrameTruth& frame) { return frame[static_cast<std::size_t>(joint)].has_value(); });
      });
  }
  Wanted out{std::move(joints), {}, {}};
  for (const JointId joint : out.joints) {
    DUO_TRY(truth.check(joint));
    const auto skeletons = tracker.skeletons();
    const auto with =
        std::find_if(skeletons.begin(), skeletons.end(), [&](const Skeleton* s) { return s->index_of(joint).has_value(); });
    if (with == skeletons.end())
      return Error{ErrorCode::kBadInput, fmt::format("cannot score {}: the tracker {} finds {}", name_of(joint), tracker.name(),
                                                     joint_names(skeletons))};
    if (tracker.starts_by_itself() || std::find(out.skeletons.begin(), out.skeletons.end(), *with) != out.skeletons.end())
      continue;
    out.skeletons.push_back(*with);
    add(**with, out.clicked);
  }
  for (const JointId joint : out.clicked) DUO_TRY(truth.check(joint));
  return out;
}

Result<std::unique_ptr<PairSource>> open_clip(const std::filesystem::path& folder, const ClipTruth& truth) {
  return open_pairs(folder / "left.avi", folder / "right.avi", {.skew_ns = std::llround(truth.skew_ms * 1e6)});
}

std::vector<Selection> selections_in(const Wanted& want, const FrameTruth& frame, double jitter_px) {
  std::vector<Selection> selections;
  std::mt19937 random(1);
  for (const Skeleton* skeleton : want.skeletons) selections.push_back(clicks(*skeleton, frame, jitter_px, random));
  return selections;
}

/// Depth as it is made where no tracker asks for other fractions, of the frames from `first` on whose depth is known.
Result<std::optional<DepthScore>> score_depth(const std::filesystem::path& folder, const ClipTruth& truth, PipelineSetup setup,
                                              std::int64_t first) {
  std::vector<std::int64_t> known;
  for (std::int64_t i = first; i < static_cast<std::int64_t>(truth.frames.size()); ++i)
    if (has_depth_truth(folder, i)) known.push_back(i);
  if (known.empty()) return std::optional<DepthScore>();
  setup.tracker.clear();
  setup.focus = PeopleFocus::kOff;
  setup.check = RigCheck::kNone;
  setup.first = known[0];
  setup.every = 0;
  for (const std::int64_t i : known) setup.every = std::gcd(setup.every, i - known[0]);
  if (setup.every == 0) setup.every = 1;
  DUO_TRY_ASSIGN(auto pairs, open_clip(folder, truth));
  const double frame_s = pairs->frame_s();
  DUO_TRY_ASSIGN(Pipeline pipeline, Pipeline::open(std::move(pairs), std::move(setup)));
  DepthTally tally;
  for (std::int64_t i = -1; i < known.back();) {
    DUO_TRY_ASSIGN(const Next next, pipeline.next());
    if (next != Next::kNew) break;
    i = std::llround(static_cast<double>(pipeline.pair()->left.t_ns) * 1e-9 / frame_s);
    if (!has_depth_truth(folder, i)) continue;  // a pair before it is missing
    DUO_TRY_ASSIGN(const DepthTruth of_frame, load_depth_truth(folder, i));
    tally.add(*pipeline.frame(), pipeline.header().rectified, truth.rig.left, of_frame);
  }
  return tally.score();
}

}  // namespace

Result<ClipScore> score_clip(const std::filesystem::path& folder, const ClipTruth& truth, ClipEvaluation what) {
  PipelineSetup& setup = what.pipeline;
  DUO_TRY_ASSIGN(auto tracker, make_tracker(setup.tracker));
  DUO_TRY_ASSIGN(const Wanted want, wanted(*tracker, truth, what.joints));
  ClipScore score;
  score.clip = truth.name;
  score.tracker = setup.tracker;
  DUO_TRY_ASSIGN(score.first, truth.first_visible(want.clicked));
  DUO_TRY_ASSIGN(auto pairs, open_clip(folder, truth));
  const double frame_s = pairs->frame_s();
  setup.frames.many_at_once = false;  // other frames would be made while a frame is scored
  setup.frames.wants.disparity = true;
  const PipelineSetup of_depth = setup;
  DUO_TRY_ASSIGN(Pipeline pipeline, Pipeline::open(std::move(pairs), std::move(setup), std::move(tracker)));
  const Rectified& rectified = pipeline.header().rectified;
  if (what.add_sinks) DUO_TRY(what.add_sinks(pipeline));
  std::vector<std::vector<JointSample>> samples(want.joints.size());
  Identities identities;
  std::int64_t busy_ns = 0;  // without scoring, during which nothing goes on in the background
  const auto count = static_cast<std::int64_t>(truth.frames.size());
  for (std::int64_t i = -1; i < count - 1;) {
    const std::int64_t begin_ns = wall_ns();
    DUO_TRY_ASSIGN(const Next next, pipeline.next());
    if (next != Next::kNew)
      return Error{ErrorCode::kBadInput, fmt::format("cannot evaluate {}: its videos end before frame {} of {} in truth.json",
                                                     folder.string(), i + 1, count)};
    // By its time: a frame of which a camera gave no picture has no pair.
    i = std::llround(static_cast<double>(pipeline.pair()->left.t_ns) * 1e-9 / frame_s);
    if (i < score.first || i >= count) continue;
    const FrameTruth& frame = truth.frames[static_cast<std::size_t>(i)];
    if (score.frames == 0 && !want.skeletons.empty()) DUO_TRY(pipeline.select(selections_in(want, frame, what.jitter_px)));
    pipeline.wait();
    busy_ns += wall_ns() - begin_ns;
    for (std::size_t j = 0; j < want.joints.size(); ++j) {
      const JointId id = want.joints[j];
      samples[j].push_back(sample(frame, id, pipeline.people(), rectified.rig_from_left));
    }
    const bool whole = want.skeletons.empty();  // else people are arms, and one has two
    if (whole) identities.add(0, frame, pipeline.people(), rectified.rig_from_left);
    for (std::size_t k = 0; whole && k < truth.others.size(); ++k)
      identities.add(k + 1, truth.others[k][static_cast<std::size_t>(i)], pipeline.people(), rectified.rig_from_left);
    DUO_TRY(pipeline.write());
    ++score.frames;
  }
  score.left_out = count - score.first - score.frames;
  score.fps = 1e9 * static_cast<double>(score.frames) / static_cast<double>(busy_ns);
  for (std::size_t j = 0; j < want.joints.size(); ++j) score.joints.emplace_back(want.joints[j], score_joint(samples[j]));
  score.people = 1 + static_cast<int>(truth.others.size());
  score.identity_switches = identities.switches();
  DUO_TRY(pipeline.finish_sinks());
  DUO_TRY_ASSIGN(score.depth, score_depth(folder, truth, of_depth, score.first));
  return score;
}

}  // namespace duo
