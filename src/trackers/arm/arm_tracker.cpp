#include "trackers/arm/arm_tracker.h"

#include <utility>

#include "core/check.h"
#include "trackers/arm/arm.h"
#include "trackers/arm/raw_left.h"

namespace duo {
namespace {

using arm::kMostArms;

class ArmTracker final : public Tracker {
 public:
  const char* name() const override { return "arm"; }
  Wants wants() const override { return {.color = true}; }
  Result<void> prepare(const TrackerSetup& setup) override;
  Result<void> select(const Frame& frame, const std::vector<ArmSelection>& selections) override;
  const std::vector<ArmPose>& track(const Frame& frame) override;
  void reset() override;

 private:
  void publish();

  std::optional<arm::RawLeft> view_;  // empty before prepare()
  double frame_s_ = 0;
  arm::Grid grid_;
  arm::GrayLevels gray_;
  std::vector<arm::Arm> arms_;
  std::vector<ArmPose> poses_;
  std::uint64_t selected_on_ = 0;  // sequence number: the first track() may be given the same frame
  bool just_selected_ = false;
};

Result<void> ArmTracker::prepare(const TrackerSetup& setup) {
  DUO_TRY_ASSIGN(const auto view, arm::RawLeft::of(setup));
  reset();
  view_.emplace(view);
  frame_s_ = setup.frame_s;
  grid_ = arm::Grid(setup.rectified);
  gray_ = arm::GrayLevels(setup.rectified);
  return {};
}

Result<void> ArmTracker::select(const Frame& frame, const std::vector<ArmSelection>& selections) {
  DUO_CHECK(view_.has_value());
  DUO_TRY(view_->check(frame, selections.size()));
  grid_.build(frame);
  gray_.build(frame);
  std::vector<arm::Arm> arms;
  for (std::size_t n = 0; n < selections.size(); ++n) {
    DUO_TRY_ASSIGN(const auto clicks, view_->rectified(selections[n]));
    arms.emplace_back(grid_, frame_s_);
    DUO_TRY(arms.back().start({grid_, gray_}, clicks));
  }
  arms_ = std::move(arms);
  poses_.assign(arms_.size(), {});
  selected_on_ = frame.sequence;
  just_selected_ = true;
  publish();
  return {};
}

const std::vector<ArmPose>& ArmTracker::track(const Frame& frame) {
  if (arms_.empty()) return poses_;
  if (std::exchange(just_selected_, false) && frame.sequence == selected_on_) return poses_;
  grid_.build(frame);
  gray_.build(frame);
  // Both arms see the other's hand where it was, so that their order does not matter.
  std::array<Vec3, kMostArms> hands;
  std::array<bool, kMostArms> seen;
  for (std::size_t n = 0; n < arms_.size(); ++n) {
    const arm::TrackedJoint& hand = arms_[n].joint(Joint::kHand);
    hands[n] = hand.p + hand.step;
    seen[n] = hand.seen();
  }
  const double skew_s = static_cast<double>(frame.skew_ns) * 1e-9;
  for (std::size_t n = 0; n < arms_.size(); ++n) {
    const std::size_t other = 1 - n;
    const bool rival = arms_.size() == kMostArms && seen[other];
    arms_[n].track({grid_, gray_, skew_s}, rival ? std::span<const Vec3>(&hands[other], 1) : std::span<const Vec3>());
  }
  publish();
  return poses_;
}

void ArmTracker::reset() {
  arms_.clear();
  poses_.clear();
}

void ArmTracker::publish() {
  for (std::size_t n = 0; n < arms_.size(); ++n)
    for (const Joint which : {Joint::kHand, Joint::kElbow, Joint::kShoulder}) {
      const arm::TrackedJoint& joint = arms_[n].joint(which);
      Keypoint& out = poses_[n][which];
      out = {joint.p, joint.sigma_m, joint.confidence, out.u_px, out.v_px, joint.state};
      view_->set_pixel(out);
    }
}

}  // namespace

std::unique_ptr<Tracker> make_arm_tracker() { return std::make_unique<ArmTracker>(); }

}  // namespace duo
