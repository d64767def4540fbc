#include "trackers/arm/thesis_tracker.h"

#include <fmt/format.h>

#include <cmath>
#include <utility>

#include "core/check.h"
#include "trackers/arm/raw_left.h"
#include "trackers/arm/thesis_blob.h"
#include "trackers/arm/thesis_points.h"

namespace duo {
namespace {

constexpr double kSigmaM = 0.05, kSigmaGrowthMPerS = 0.9, kLostAfterS = 1;

struct FollowedJoint {
  arm::JointPoints points;
  double z_m = 0;  // the last one read back
  int unseen = 0;  // frames
};

class ThesisTracker final : public Tracker {
 public:
  const char* name() const override { return "arm"; }
  Result<void> prepare(const TrackerSetup& setup) override;
  Result<void> select(const Frame& frame, const std::vector<ArmSelection>& selections) override;
  const std::vector<ArmPose>& track(const Frame& frame) override;
  void reset() override;

 private:
  void publish();
  double depth_m(const Frame& frame, Vec2 at_px) const;

  Pool pool_{1};
  std::optional<arm::RawLeft> view_;  // empty before prepare()
  double frame_s_ = 0;
  arm::BlobFinder blob_finder_;
  arm::PointFinder point_finder_;
  std::vector<arm::Blob> blobs_;  // three an arm, in the order of Joint
  std::vector<FollowedJoint> joints_;
  std::vector<ArmPose> poses_;
};

Result<void> ThesisTracker::prepare(const TrackerSetup& setup) {
  DUO_TRY_ASSIGN(const auto view, arm::RawLeft::of(setup));
  reset();
  view_.emplace(view);
  frame_s_ = setup.frame_s;
  const Size size = setup.rectified.size;
  blob_finder_ = arm::BlobFinder(size);
  const Window window = blob_finder_.window_at({0, 0});
  point_finder_ = arm::PointFinder({window.width, window.height});
  return {};
}

/// Depth at one pixel, as in the thesis; 0 = none.
double ThesisTracker::depth_m(const Frame& frame, Vec2 at_px) const {
  const Rectified& g = view_->geometry();
  const int x = static_cast<int>(std::lround(at_px.x)), y = static_cast<int>(std::lround(at_px.y));
  if (x < 0 || y < 0 || x >= g.size.width || y >= g.size.height) return 0;
  const std::uint16_t d = frame.disparity.d_q4.at(y, x);
  return d == 0 || d == Disparity::kNone ? 0 : 16 * g.focal_px * g.baseline_m / d;
}

Result<void> ThesisTracker::select(const Frame& frame, const std::vector<ArmSelection>& selections) {
  DUO_CHECK(view_.has_value());
  DUO_TRY(view_->check(frame, selections.size()));
  std::vector<arm::Blob> blobs;
  std::vector<FollowedJoint> joints;
  blob_finder_.look_at(pool_, frame);
  for (const ArmSelection& selection : selections) {
    DUO_TRY_ASSIGN(const auto clicks, view_->rectified(selection));
    for (std::size_t i = 0; i < clicks.size(); ++i) {
      const auto refused = [&](const char* what, const char* then) {
        return Error{ErrorCode::kBadInput, fmt::format("select the arm: {} at the {} click; {}", what, kJointNames[i], then)};
      };
      const auto blob = blob_finder_.learn(pool_, clicks[i]);
      if (!blob) return refused("no colour", "this preset follows colours, so click on one");
      FollowedJoint joint;
      joint.z_m = depth_m(frame, clicks[i]);
      if (!(joint.z_m > 0)) return refused("no depth", "click on a textured part, or choose another frame");
      point_finder_.learn(pool_, frame.left, blob_finder_.window_at(clicks[i]), clicks[i], joint.points);
      blobs.push_back(*blob);
      joints.push_back(std::move(joint));
    }
  }
  blobs_ = std::move(blobs);
  joints_ = std::move(joints);
  poses_.assign(selections.size(), {});
  publish();
  return {};
}

const std::vector<ArmPose>& ThesisTracker::track(const Frame& frame) {
  if (poses_.empty()) return poses_;
  blob_finder_.look_at(pool_, frame);
  std::array<Window, kMaxTargets> windows;
  for (std::size_t i = 0; i < blobs_.size(); ++i) windows[i] = blob_finder_.window_at(blobs_[i].at_px);
  std::array<bool, kMaxTargets> found{};
  blob_finder_.find(pool_, blobs_, found);
  for (std::size_t i = 0; i < blobs_.size(); ++i) {
    arm::Blob& blob = blobs_[i];
    const auto second = point_finder_.find(pool_, frame.left, windows[i], joints_[i].points);
    if (second && found[i])
      blob.at_px = {(blob.at_px.x + second->x) / 2, (blob.at_px.y + second->y) / 2};
    else if (second)
      blob.at_px = *second;
    joints_[i].unseen = second || found[i] ? 0 : joints_[i].unseen + 1;
    if (const double z = depth_m(frame, blob.at_px); z > 0) joints_[i].z_m = z;
  }
  publish();
  return poses_;
}

void ThesisTracker::reset() {
  blobs_.clear();
  joints_.clear();
  poses_.clear();
}

void ThesisTracker::publish() {
  const auto camera = arm::Pinhole::of(view_->geometry());
  for (std::size_t i = 0; i < blobs_.size(); ++i) {
    Keypoint& out = poses_[i / kArmJoints].joints[i % kArmJoints];
    const double unseen_s = joints_[i].unseen * frame_s_;
    out.p_in_rig_m = camera.point(blobs_[i].at_px, joints_[i].z_m);
    out.sigma_m = kSigmaM + kSigmaGrowthMPerS * unseen_s;
    out.state = unseen_s > kLostAfterS ? JointState::kLost : unseen_s > 0 ? JointState::kInferred : JointState::kSeen;
    out.confidence = std::max(0.0, 1 - unseen_s / kLostAfterS);
    view_->set_pixel(out);
  }
}

}  // namespace

std::unique_ptr<Tracker> make_thesis_tracker() { return std::make_unique<ThesisTracker>(); }

}  // namespace duo
