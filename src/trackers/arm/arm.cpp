#include "trackers/arm/arm.h"

#include <algorithm>
#include <cmath>

#include "stages/align_time/align_time.h"

namespace duo::arm {
namespace {

constexpr std::size_t kMostOthers = 16;

/// A step no longer than `speed` allows.
Vec3 limited(Vec3 step, double longest_m) {
  const double length = norm(step);
  return length > longest_m ? (longest_m / length) * step : step;
}

double square(double x) { return x * x; }

/// A log likelihood ratio as a probability.
double confidence_of(double score) { return 1 / (1 + std::exp(-score)); }

/// A joint that was not measured: believed less from second to second.
void hide(TrackedJoint& joint, double sigma_m, double lost_m, double unseen_s) {
  joint.sigma_m = sigma_m;
  joint.state = sigma_m > lost_m ? JointState::kLost : JointState::kInferred;
  joint.confidence = joint.state == JointState::kLost ? 0 : 0.5 * std::exp(-unseen_s);
}

}  // namespace

Arm::Arm(const Grid& grid, double frame_s)
    : frame_s_(frame_s),
      background_(grid),
      silhouette_(grid),
      skin_regions_(grid),
      limb_regions_(grid),
      other_regions_(grid),
      hands_(grid),
      mask_(static_cast<std::size_t>(grid.size())),
      scratch_(static_cast<std::size_t>(grid.size())) {
  others_.reserve(kMostOthers);
}

const TrackedJoint& Arm::joint(Part which) const {
  return which == Part::kHand ? hand_ : which == Part::kElbow ? elbow_ : shoulder_;
}

void Arm::track(const Scene& scene, std::span<const Vec3> rivals) {
  ++frame_;
  torso_.track(scene.grid, scene.gray);  // first, for the arm hangs on it: the same three steps, inside
  update_shoulder(scene.grid);

  const Prediction predicted = predict();
  const Observation seen = observe(scene, predicted, rivals);
  update(scene, predicted, seen);

  learn(scene, seen.arm);
}

// The shoulder rides on the torso; the collar bone moves it with the upper arm, of some people more than of others.
void Arm::update_shoulder(const Grid& grid) {
  constexpr double kMostUpM = 0.05, kMostDownM = 0.06, kMostForwardM = 0.04, kLiftDoubt = 0.4;
  const Vec3 before = shoulder_.p;
  const Vec3 turned = transposed(torso_.rig_from_torso().rotation) * normalized(elbow_.p - shoulder_.p) - first_upper_;
  const double lift_m = std::clamp(params_.shoulder_lift_m * turned.y, -kMostUpM, kMostDownM),
               forward_m = std::clamp(params_.shoulder_forward_m * turned.z, -kMostForwardM, kMostForwardM);
  shoulder_.p = torso_.rig_from_torso() * (Vec3{0, lift_m, forward_m} + shoulder_behind_m_ * first_ray_);
  shoulder_.step = shoulder_.p - before;
  shoulder_.unseen = torso_.unseen();
  const double measured_m = std::hypot(params_.shoulder_sigma_m,
                                       0.5 * grid.z_sigma_m(shoulder_.p.z, params_.disparity_sigma_px), kLiftDoubt * lift_m);
  const double unseen_s = seconds(shoulder_.unseen);
  hide(shoulder_, measured_m + params_.shoulder_sigma_growth_m_s * unseen_s, lengths_.reach_m(), unseen_s);
  if (!torso_.seen()) return;
  shoulder_.state = JointState::kSeen;
  shoulder_.confidence = torso_.inliers() / (torso_.inliers() + 5.0);
}

// Constant velocity within what an arm can do; a hidden hand moves with the torso.
Arm::Prediction Arm::predict() const {
  constexpr double kHiddenDrift = 0.6;
  Prediction out;
  if (hand_.seen())
    out.hand = hand_.p + limited(hand_.step, params_.fastest_hand_m_s * frame_s_);
  else
    out.hand = torso_.moved(hand_.p) + kHiddenDrift * (hand_.step - shoulder_.step);
  const Vec3 elbow = elbow_.p + limited(elbow_.step, params_.fastest_elbow_m_s * frame_s_);
  out.elbow = shoulder_.p + lengths_.upper_m * normalized(elbow - shoulder_.p);
  return out;
}

// A hand whose elbow nothing supports may be another part of the arm, whose hand is hidden or out of the picture: an elbow
// anywhere else is weighed against it.
Arm::Observation Arm::observe(const Scene& scene, const Prediction& predicted, std::span<const Vec3> rivals) {
  constexpr double kDoubtful = -1, kLeastLead = 1.5, kBetter = 0.5;
  find_silhouette(scene.grid, rivals);
  Observation out;
  out.arm = best_candidate(scene, predicted);
  if (out.arm && !(out.arm->score > least_score(*out.arm))) out.arm.reset();
  if (out.arm) out.elbow = out.arm->elbow;
  if (out.arm && out.elbow.score > kDoubtful) return out;

  constexpr double kGrowthMPerS = 0.3, kAnywhereM = 0.35;
  const ElbowFinder finder(scene.grid, silhouette_, lengths_, params_);
  const ElbowSeen anywhere = finder.anywhere(shoulder_.p, {predicted.elbow, kAnywhereM});
  if (out.arm && !(anywhere.score > std::max(0.0, out.elbow.score + kLeastLead))) return out;
  out.arm.reset();
  out.elbow = finder.near(shoulder_.p, {predicted.elbow, params_.elbow_prior_m + kGrowthMPerS * seconds(elbow_.unseen)});
  const double least_lead = out.elbow.score > 0 ? kLeastLead : kBetter;
  if (anywhere.score > out.elbow.score + least_lead) out.elbow = anywhere;
  return out;
}

void Arm::update(const Scene& scene, const Prediction& predicted, const Observation& seen) {
  update_hand(scene, predicted, seen.arm);
  update_elbow(scene, predicted, seen);
  if (seen.arm) return;
  if (elbow_.seen()) follow_hand_outside(scene.grid);
  const Vec3 fore = hand_.p - elbow_.p;  // a hidden hand stays within the forearm's reach
  hand_.p = elbow_.p + (std::min(lengths_.fore_m, norm(fore)) / std::max(1e-6, norm(fore))) * fore;
}

/// A hand that left the picture is where the rest of its forearm points.
void Arm::follow_hand_outside(const Grid& grid) {
  constexpr double kGain = 0.5;
  const double sigma_m = params_.hand_prior_m + params_.hand_prior_growth_m_s * seconds(hand_.unseen);
  if (const auto outside = ElbowFinder(grid, silhouette_, lengths_, params_).hand_outside(elbow_.p, {hand_.p, sigma_m}))
    hand_.p = hand_.p + kGain * (*outside - hand_.p);
}

// A joint that moves along the baseline by v dt between the two pictures seems z v dt / b off in depth; the pictures were put
// to one moment, and a share of that is left. In which direction the speed is wrong nobody knows, so all of it counts.
double Arm::skew_sigma_m(const Scene& scene, const TrackedJoint& joint) const {
  return ref::AlignTime::kErrorLeft * joint.p.z * norm(joint.step) / frame_s_ * std::abs(scene.skew_s) /
         scene.grid.camera.baseline_m;
}

void Arm::update_hand(const Scene& scene, const Prediction& predicted, const std::optional<Candidate>& seen) {
  constexpr double kGain = 0.85, kStepGain = 0.7, kHiddenStep = 0.7, kMostSigmaM = 2;
  constexpr int kForgetStep = 2;  // frames: after a gap the way since the last measurement says nothing of speed
  if (!seen) {
    hand_.p = predicted.hand;
    hand_.step = kHiddenStep * hand_.step;
    ++hand_.unseen;
    hide(hand_, std::min(kMostSigmaM, hand_.sigma_m + params_.hand_sigma_growth_m_s * frame_s_), lengths_.reach_m(),
         seconds(hand_.unseen));
    return;
  }
  const Vec3 now = predicted.hand + (hand_.seen() ? kGain : 1) * (seen->hand.p - predicted.hand), step = now - hand_.p;
  hand_.step = hand_.unseen > kForgetStep ? Vec3{} : (1 - kStepGain) * hand_.step + kStepGain * step;
  hand_.p = now;
  hand_.unseen = 0;
  hand_.state = JointState::kSeen;
  hand_.confidence = confidence_of(seen->score);
  hand_.sigma_m = std::sqrt(square(params_.hand_sigma_m) +
                            square(params_.hand_depth_sigmas * scene.grid.z_sigma_m(now.z, params_.disparity_sigma_px)) +
                            square(params_.hand_lag * norm(step)) + square(params_.hand_cut_sigma_m * seen->hand.cut) +
                            square(skew_sigma_m(scene, hand_)));
}

void Arm::update_elbow(const Scene& scene, const Prediction& predicted, const Observation& seen) {
  constexpr double kGain = 0.8, kStepGain = 0.5, kHiddenStep = 0.6, kLeastHiddenSigmaM = 0.04, kMostSigmaM = 1.5;
  constexpr double kLeastWithHand = -2, kLeastAlone = 0;
  if (!(seen.elbow.score > (seen.arm ? kLeastWithHand : kLeastAlone))) {
    elbow_.p = seen.arm ? seen.elbow.p : predicted.elbow;
    elbow_.step = kHiddenStep * elbow_.step;
    ++elbow_.unseen;
    const double sigma_m = std::max(elbow_.sigma_m, kLeastHiddenSigmaM) + params_.elbow_sigma_growth_m_s * frame_s_;
    hide(elbow_, std::min(kMostSigmaM, sigma_m), 2 * lengths_.upper_m, seconds(elbow_.unseen));
    return;
  }
  const Vec3 now = predicted.elbow + kGain * (seen.elbow.p - predicted.elbow);
  elbow_.step = (1 - kStepGain) * elbow_.step + kStepGain * (now - elbow_.p);
  elbow_.p = now;
  elbow_.unseen = 0;
  elbow_.state = JointState::kSeen;
  elbow_.confidence = confidence_of(seen.elbow.score);
  const double cut = seen.arm ? seen.arm->hand.cut : 0;
  elbow_.sigma_m = std::hypot(params_.elbow_sigma_m, seen.elbow.spread_m, params_.elbow_cut_sigma_m * cut);
  elbow_.sigma_m = std::hypot(elbow_.sigma_m, skew_sigma_m(scene, elbow_));
}

void Arm::find_silhouette(const Grid& grid, std::span<const Vec3> rivals) {
  others_.resize(own_others_);
  const Rigid3 torso_from_rig = inverse(torso_.rig_from_torso());
  for (OtherSkin& o : others_) o.p = o.head ? torso_.rig_from_torso() * o.p_in_torso_m : o.p + shoulder_.step;
  for (const Vec3 rival : rivals)
    if (others_.size() < kMostOthers) others_.push_back({rival, {}, false, 0});
  background_.observe(grid);
  silhouette_.find({grid, background_, colors_, body_skin_, body_, others_, torso_from_rig, shoulder_.p, hand_.p, hand_.seen(),
                    lengths_.reach_m()},
                   params_);
}

}  // namespace duo::arm
