#include "trackers/thesis/thesis_tracker.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/check.h"
#include "stages/sums/sums.h"
#include "trackers/pinhole.h"
#include "trackers/raw_left.h"
#include "trackers/thesis/device_observer.h"
#include "trackers/thesis/map_observer.h"

namespace duo {
namespace {

constexpr double kSigmaM = 0.05, kSigmaGrowthMPerS = 0.9, kLostAfterS = 1;

struct FollowedJoint {
  PlaceQ4 at;            // where it was last
  std::uint8_t hue = 0;  // 256 = full circle
  double z_m = 0;        // the last one read back
  int unseen = 0;        // frames
};

PlaceQ4 place_of(Vec2 at_px) {
  return {static_cast<std::int32_t>(std::lround(16 * at_px.x)), static_cast<std::int32_t>(std::lround(16 * at_px.y))};
}

class ThesisTracker final : public Tracker {
 public:
  const char* name() const override { return "thesis"; }
  std::span<const Skeleton* const> skeletons() const override { return arm::kArms; }
  Wants wants() const override { return {.views = false, .disparity = false, .on_device = true}; }
  Result<void> prepare(const TrackerSetup& setup) override;
  Result<std::span<const Person>> select(const Frame& frame, std::span<const Selection> selections) override;
  std::span<const Person> track(const Frame& frame) override;
  void reset() override;
  std::span<const StageTime> stages() const override { return seen_.stages; }

 private:
  void expect();
  bool observe(const Frame& frame);
  void publish();
  double depth_m(std::uint32_t d_q4) const;
  Result<FollowedJoint> learn(const Frame& frame, Vec2 click_px, std::string_view joint);

  std::optional<arm::RawLeft> view_;  // empty before prepare()
  double frame_s_ = 0;
  std::optional<thesis::MapObserver> map_observer_;  // likewise
  std::unique_ptr<thesis::DeviceObserver> device_observer_ = thesis::make_device_observer();
  std::vector<FollowedJoint> joints_;  // three per arm, in the order of its skeleton
  Expectation expected_;
  Observation seen_;
  std::vector<Person> people_;
};

Result<void> ThesisTracker::prepare(const TrackerSetup& setup) {
  DUO_TRY_ASSIGN(const auto view, arm::RawLeft::of(setup));
  reset();
  view_.emplace(view);
  frame_s_ = setup.frame_s;
  map_observer_.emplace(setup.rectified.size);
  return {};
}

/// 0 = none.
double ThesisTracker::depth_m(std::uint32_t d_q4) const {
  return d_q4 == 0 || d_q4 == Disparity::kNone ? 0 : view_->geometry().depth_m(d_q4 / 16.0);
}

/// Of a click on maps that are looked at.
Result<FollowedJoint> ThesisTracker::learn(const Frame& frame, Vec2 click_px, std::string_view joint) {
  const auto refused = [&](const char* what, const char* then) {
    return Error{ErrorCode::kBadInput, fmt::format("select the arm: {} at the {} click; {}", what, joint, then)};
  };
  FollowedJoint out{place_of(click_px)};
  const Pixel p = out.at.pixel();
  const auto hue = map_observer_->hue_at(p);
  if (!hue) return refused("no colour", "the thesis's tracker follows colours, so click on one");
  out.hue = *hue;
  const Image<std::uint16_t>& d_q4 = frame.disparity.d_q4;
  if (p.x < d_q4.width() && p.y < d_q4.height() && p.x >= 0 && p.y >= 0) out.z_m = depth_m(d_q4.at(p.y, p.x));
  if (!(out.z_m > 0)) return refused("no depth", "click on a textured part, or choose another frame");
  return out;
}

Result<std::span<const Person>> ThesisTracker::select(const Frame& frame, std::span<const Selection> selections) {
  DUO_CHECK(view_.has_value());
  const Frame* maps = &frame;
  if (frame.on_device != nullptr) {
    DUO_TRY_ASSIGN(maps, device_observer_->maps(*frame.on_device));
  }
  DUO_TRY(view_->check(*maps, selections.size()));
  std::vector<FollowedJoint> joints;
  auto points = std::make_shared<std::vector<JointPoints>>();
  map_observer_->begin(*maps);
  for (const Selection& selection : selections) {
    DUO_TRY_ASSIGN(const auto clicks, view_->rectified(selection));
    for (std::size_t i = 0; i < clicks.size(); ++i) {
      DUO_TRY_ASSIGN(const FollowedJoint joint, learn(*maps, clicks[i], selection.skeleton->joints[i].name));
      joints.push_back(joint);
      points->push_back(map_observer_->points_around(joint.at));
    }
  }
  joints_ = std::move(joints);
  expected_.points = std::move(points);
  people_ = arm::persons_of(selections);
  return track(frame);  // where the colours are around the clicks
}

std::span<const Person> ThesisTracker::track(const Frame& frame) {
  if (people_.empty()) return people_;
  expect();
  const bool looked = observe(frame);
  for (std::size_t i = 0; i < joints_.size(); ++i) {
    FollowedJoint& joint = joints_[i];
    const ObservedJoint seen = looked ? seen_.joints[i] : ObservedJoint{joint.at};
    joint.at = seen.at;
    joint.unseen = seen.seen_by != 0 ? 0 : joint.unseen + 1;
    if ((seen.seen_by & kSeenByColor) != 0) joint.hue = mean_hue(seen_.colors[i]).value_or(joint.hue);
    if (const double z = depth_m(seen.d_q4); z > 0) joint.z_m = z;
  }
  publish();
  return people_;
}

void ThesisTracker::expect() {
  expected_.count = static_cast<int>(joints_.size());
  for (std::size_t i = 0; i < joints_.size(); ++i) {
    const FollowedJoint& joint = joints_[i];
    expected_.joints[i] = {thesis::blob_target(joint.hue, thesis::joint_window(view_->geometry().size, joint.at)), joint.at};
  }
}

/// On the device where the frame lies there, else in its maps.
bool ThesisTracker::observe(const Frame& frame) {
  if (frame.on_device != nullptr) return device_observer_->observe(*frame.on_device, expected_, seen_);
  map_observer_->begin(frame);
  map_observer_->observe(expected_, seen_);
  return true;
}

void ThesisTracker::reset() {
  joints_.clear();
  people_.clear();
}

void ThesisTracker::publish() {
  const Pinhole& camera = view_->geometry();
  for (std::size_t i = 0; i < joints_.size(); ++i) {
    const FollowedJoint& joint = joints_[i];
    Joint& out = people_[i / arm::kParts].joints[i % arm::kParts];
    const double unseen_s = joint.unseen * frame_s_;
    out.p_in_rig_m = camera.unproject({joint.at.x / 16.0, joint.at.y / 16.0}, joint.z_m);
    out.cov_m2 = Covariance3::isotropic(kSigmaM + kSigmaGrowthMPerS * unseen_s);
    out.state = unseen_s > kLostAfterS ? JointState::kLost : unseen_s > 0 ? JointState::kInferred : JointState::kSeen;
    out.confidence = std::max(0.0, 1 - unseen_s / kLostAfterS);
    view_->set_pixel(out);
  }
  for (Person& person : people_) person.sum_up();
}

}  // namespace

std::unique_ptr<Tracker> make_thesis_tracker() { return std::make_unique<ThesisTracker>(); }

}  // namespace duo
