#include "trackers/arm/arm_tracker.h"

#include "core/check.h"
#include "trackers/arm/arm.h"
#include "trackers/raw_left.h"

namespace duo {
namespace {

using arm::kMostArms, arm::Part, arm::index_of;

class ArmTracker final : public Tracker {
 public:
  const char* name() const override { return "arm"; }
  std::span<const Skeleton* const> skeletons() const override { return arm::kArms; }
  Wants wants() const override { return {.color = true}; }
  Result<void> prepare(const TrackerSetup& setup) override;
  Result<std::span<const Person>> select(const Frame& frame, std::span<const Selection> selections) override;
  std::span<const Person> track(const Frame& frame) override;
  void reset() override;

 private:
  void publish();

  std::optional<arm::RawLeft> view_;  // empty before prepare()
  double frame_s_ = 0;
  arm::Grid grid_;
  arm::GrayLevels gray_;
  std::vector<arm::Arm> arms_;
  std::vector<Person> people_;  // of arms_
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

Result<std::span<const Person>> ArmTracker::select(const Frame& frame, std::span<const Selection> selections) {
  DUO_CHECK(view_.has_value());
  DUO_TRY(view_->check(frame, selections.size()));
  grid_.build(frame);
  gray_.build(frame);
  std::vector<arm::Arm> arms;
  for (const Selection& selection : selections) {
    DUO_TRY_ASSIGN(const auto clicks, view_->rectified(selection));
    arms.emplace_back(grid_, frame_s_);
    DUO_TRY(arms.back().start({grid_, gray_}, *selection.skeleton, clicks));
  }
  arms_ = std::move(arms);
  people_ = arm::persons_of(selections);
  publish();
  return std::span<const Person>(people_);
}

std::span<const Person> ArmTracker::track(const Frame& frame) {
  if (arms_.empty()) return people_;
  grid_.build(frame);
  gray_.build(frame);
  // Both arms see the other's hand where it was, so that their order does not matter.
  std::array<Vec3, kMostArms> hands;
  std::array<bool, kMostArms> seen;
  for (std::size_t n = 0; n < arms_.size(); ++n) {
    const arm::TrackedJoint& hand = arms_[n].joint(Part::kHand);
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
  return people_;
}

void ArmTracker::reset() {
  arms_.clear();
  people_.clear();
}

void ArmTracker::publish() {
  for (std::size_t n = 0; n < arms_.size(); ++n) {
    for (const Part part : {Part::kShoulder, Part::kElbow, Part::kHand}) {
      const arm::TrackedJoint& joint = arms_[n].joint(part);
      Joint& out = people_[n].joints[index_of(part)];
      out.p_in_rig_m = joint.p;
      out.v_in_rig_m_s = (1 / frame_s_) * joint.step;
      out.cov_m2 = Covariance3::isotropic(joint.sigma_m);
      out.confidence = joint.confidence;
      out.state = joint.state;
      view_->set_pixel(out);
    }
    people_[n].sum_up();
  }
}

}  // namespace

std::unique_ptr<Tracker> make_arm_tracker() { return std::make_unique<ArmTracker>(); }

}  // namespace duo
