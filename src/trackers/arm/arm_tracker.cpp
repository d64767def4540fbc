#include "trackers/arm/arm_tracker.h"

#include <fmt/format.h>

#include <utility>

#include "core/check.h"
#include "trackers/arm/arm.h"

namespace duo {
namespace {

constexpr std::size_t kMostArms = 2;

class ArmTracker final : public Tracker {
 public:
  const char* name() const override { return "arm"; }
  Result<void> prepare(const TrackerSetup& setup) override;
  Result<void> select(const Frame& frame, const std::vector<ArmSelection>& selections) override;
  const std::vector<ArmPose>& track(const Frame& frame) override;
  void reset() override;

 private:
  Result<std::array<Vec2, kArmJoints>> rectified(const ArmSelection& selection) const;
  Keypoint keypoint(const arm::TrackedJoint& joint, const Keypoint& before) const;
  void publish();

  TrackerSetup setup_;
  std::optional<Lens> lens_;  // of the raw left camera; empty before prepare()
  arm::Grid grid_;
  arm::GrayLevels gray_;
  std::vector<arm::Arm> arms_;
  std::vector<ArmPose> poses_;
  std::uint64_t selected_on_ = 0;  // sequence number: the first track() may be given the same frame
  bool just_selected_ = false;
};

Result<void> ArmTracker::prepare(const TrackerSetup& setup) {
  const Size size = setup.rectified.size;
  if (size.width < 64 || size.height < 64 || !(setup.rectified.focal_px > 0) || !(setup.rectified.baseline_m > 0))
    return Error{ErrorCode::kBadInput,
                 fmt::format("prepare the arm tracker: rectified pictures of {}x{} without size or geometry; "
                             "give it what the engine's rectified() returns",
                             size.width, size.height)};
  if (!(setup.frame_s > 0 && setup.frame_s < 1))
    return Error{ErrorCode::kBadInput,
                 fmt::format("prepare the arm tracker: {} s from frame to frame is not in 0 .. 1", setup.frame_s)};
  reset();
  setup_ = setup;
  lens_.emplace(setup.rig.left);
  grid_ = arm::Grid(setup.rectified);
  gray_ = arm::GrayLevels(setup.rectified);
  return {};
}

/// The clicks on the rectified picture, in the order of Joint.
Result<std::array<Vec2, kArmJoints>> ArmTracker::rectified(const ArmSelection& selection) const {
  const Rectified& to = setup_.rectified;
  std::array<Vec2, kArmJoints> out;
  for (std::size_t i = 0; i < out.size(); ++i) {
    const Vec2 click = {selection.clicks[i].x_px, selection.clicks[i].y_px};
    const Size size = lens_->camera().size;
    const auto bad = [&](const char* why) {
      return Error{ErrorCode::kBadInput,
                   fmt::format("select the arm: the {} click ({:g}, {:g}) {} of {}x{}; click on the raw left picture",
                               kJointNames[i], click.x, click.y, why, size.width, size.height)};
    };
    if (!lens_->covers(click, 0.5)) return bad("lies outside the picture");
    const auto ray = lens_->ray_of(click);
    const Vec3 turned = ray ? to.rig_from_left * *ray : Vec3{};
    if (!(turned.z > 0)) return bad("is seen by no ray of the lens, in the picture");
    out[i] = {to.cx_px + to.focal_px * turned.x / turned.z, to.cy_px + to.focal_px * turned.y / turned.z};
    if (!(out[i].x >= 0 && out[i].y >= 0 && out[i].x <= to.size.width - 1 && out[i].y <= to.size.height - 1))
      return bad("is not seen by both cameras, in the picture");
  }
  return out;
}

Result<void> ArmTracker::select(const Frame& frame, const std::vector<ArmSelection>& selections) {
  DUO_CHECK(lens_.has_value());
  if (selections.empty() || selections.size() > kMostArms)
    return Error{ErrorCode::kBadInput,
                 fmt::format("select the arm: {} arms were given; this tracker follows 1 or 2", selections.size())};
  if (frame.color.empty() || frame.color.size() != setup_.rectified.size || frame.left.size() != setup_.rectified.size)
    return Error{ErrorCode::kBadInput,
                 "select the arm: the frame lacks the colour picture or has another size than prepared; set "
                 "wants.color in the engine's setup"};
  grid_.build(frame);
  gray_.build(frame);
  std::vector<arm::Arm> arms;
  for (std::size_t n = 0; n < selections.size(); ++n) {
    DUO_TRY_ASSIGN(const auto clicks, rectified(selections[n]));
    arms.emplace_back(grid_, setup_.frame_s);
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
  for (std::size_t n = 0; n < arms_.size(); ++n) {
    const std::size_t other = 1 - n;
    const bool rival = arms_.size() == kMostArms && seen[other];
    arms_[n].track({grid_, gray_}, rival ? std::span<const Vec3>(&hands[other], 1) : std::span<const Vec3>());
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
    for (const Joint joint : {Joint::kHand, Joint::kElbow, Joint::kShoulder})
      poses_[n][joint] = keypoint(arms_[n].joint(joint), poses_[n][joint]);
}

/// A joint that the lens does not see keeps its last pixel.
Keypoint ArmTracker::keypoint(const arm::TrackedJoint& joint, const Keypoint& before) const {
  Keypoint out{joint.p, joint.sigma_m, joint.confidence, before.u_px, before.v_px, joint.state};
  if (const auto pixel = lens_->pixel_of(transposed(setup_.rectified.rig_from_left) * joint.p)) {
    out.u_px = pixel->x;
    out.v_px = pixel->y;
  }
  return out;
}

}  // namespace

std::unique_ptr<Tracker> make_arm_tracker() { return std::make_unique<ArmTracker>(); }

}  // namespace duo
