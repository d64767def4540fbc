#include "trackers/body/body.h"

#include <algorithm>

#include "trackers/body/behind_back.h"
#include "trackers/body/hidden_by.h"
#include "trackers/body/imagined.h"

namespace duo::body {
namespace {

constexpr double kNear_m = kAnyDepth.near_m;
constexpr double kSeenDrift = 0.9, kHiddenDrift = 0.6;  // share of its step that a joint keeps in a tick
constexpr double kReachBefore_m = 0.95, kReachBehind_m = 0.6;

/// The parts of a person's depth that are possible around its trunk.
DepthRange around(double trunk_z) { return {std::max(trunk_z - kReachBefore_m, kNear_m), trunk_z + kReachBehind_m}; }

/// Whether a forearm points away from the cameras, so that it hides its own end.
bool is_end_on(const Places& places, const Limb& arm, const Lengths& lengths) {
  constexpr double kAway = 0.5;  // of its length: turned by more than 30 degrees
  return places[arm[2]].z - places[arm[1]].z > kAway * lengths[Bone::kForearm];
}

/// Whether a thigh points at the cameras, as that of somebody who sits, so that it hides its hip.
bool is_behind_thigh(const Places& places, const Limb& leg, const Lengths& lengths) {
  constexpr double kTowards = 0.5;
  return places[leg[0]].z - places[leg[1]].z > kTowards * lengths[Bone::kThigh];
}

/// A hand that its network found far from where the body's network has it is another one.
bool belongs(const SeenHand& hand, const Point& wrist, double px_per_m) {
  constexpr double kNear_hand_m = 0.12;
  constexpr std::uint16_t kSure = 16384;
  if (hand.score_q15 < kSure) return false;
  return distance({hand.points[0].x_px(), hand.points[0].y_px()}, wrist.at_px) < kNear_hand_m * px_per_m;
}

}  // namespace

std::optional<Body> Body::start(const FrameView& frame, const SeenBody& seen) {
  constexpr double kLeastScale = 0.5, kMostScale = 1.4, kBehind_m = 0.1;
  const double z = trunk_depth(frame.depth, corners_of(seen), kAnyDepth);
  if (z == 0 || !stands_out(frame.depth, corners_of(seen))) return std::nullopt;
  // How large the person is: the trunk as it is seen beside the trunk as the network imagines it.
  const Lengths adult;
  const double px_per_m = frame.depth.px_per_m(z + kBehind_m);
  const Points points = points_of(seen, frame.model, frame.picture.size(), px_per_m, adult[Bone::kShoulders], 0, 0);
  const auto at = [&](JointId id) { return points[id].at_px; };
  const double trunk_px = distance(mean(at(JointId::kLeftShoulder), at(JointId::kRightShoulder)),
                                   mean(at(JointId::kLeftHip), at(JointId::kRightHip)));
  const Vec3 up = 0.5 * (seen.at(BodyPoint::kLeftShoulder).world_m() + seen.at(BodyPoint::kRightShoulder).world_m());
  const double upright = std::sqrt(square(up.x) + square(up.y)) / std::max(norm(up), 1e-6);
  const double scale = trunk_px / px_per_m / std::max(upright, 0.5) / adult[Bone::kTrunk];
  if (!(scale > kLeastScale && scale < kMostScale)) return std::nullopt;
  Body body(std::clamp(scale, 0.6, 1.12));
  body.fitted_.places = imagined(frame, seen, points, z);
  body.trunk_z_m_ = z;
  return body;
}

Vec3 Body::expected_trunk() const {
  using enum JointId;
  const auto at = [&](JointId id) { return fitted_.places[id] + states_[id].step; };
  return middle(middle(at(kLeftShoulder), at(kRightShoulder)), middle(at(kLeftHip), at(kRightHip)));
}

void Body::stretch_step(double times) {
  constexpr double kLongestStretched_m = 0.2;  // nobody knows where it goes meanwhile
  if (age_ < 2) return;                        // one frame shows no speed
  const auto stretched = [&](Vec3 step) {
    const double now = times * norm(step), most = std::max(kLongestStretched_m, norm(step));
    return (now > most ? most / now * times : times) * step;
  };
  pace_ = stretched(pace_);
  for (const JointId id : kFreeJoints) states_[id].step = stretched(states_[id].step);
}

TurnedSquare Body::expected_region(const FrameView& frame) const {
  const Vec3 p = expected_trunk();
  const Vec2 now = frame.depth.geometry->project({p.x, p.y, std::max(p.z, kNear_m)});
  TurnedSquare out = region_;
  const auto q8 = [](double px) { return static_cast<std::int32_t>(std::lround(256 * std::clamp(px, -1e5, 1e5))); };
  out.x_q8 += q8(now.x - region_from_px_.x);
  out.y_q8 += q8(now.y - region_from_px_.y);
  return out;
}

Window Body::expected_box(const FrameView& frame) const {
  constexpr double kAround_m = 0.1;
  double x0 = 1e9, x1 = -1e9, y0 = 1e9, y1 = -1e9;
  for (const JointId id : kFreeJoints) {
    const Vec3 p = fitted_.places[id] + pace_;
    if (p.z < kNear_m) continue;
    const Vec2 at = frame.depth.geometry->project(p);
    const double around = kAround_m * frame.depth.px_per_m(p.z);
    x0 = std::min(x0, at.x - around);
    x1 = std::max(x1, at.x + around);
    y0 = std::min(y0, at.y - around);
    y1 = std::max(y1, at.y + around);
  }
  if (x0 > x1) return {};
  const auto whole = [](double px) { return static_cast<int>(std::clamp(px, -1e4, 1e4)); };
  return {whole(x0), whole(y0), whole(x1) - whole(x0) + 1, whole(y1) - whole(y0) + 1};
}

void Body::track(const FrameView& frame, const SeenBody& seen, const Hands& hands, std::span<const Places* const> nearer) {
  Scene scene;
  Choices chosen;
  scene.depth = frame.depth;
  scene.lengths = &lengths_;
  scene.map = &map_;
  scene.nearer = nearer;

  predict(scene, frame.ticks());
  if (missed_ > 0) {
    sides_.forget();
    leg_sides_.forget();
  }
  const bool exchanged = sides_.are_exchanged(seen, expected_corners(scene), frame.ticks());
  const Hands own = exchanged ? Hands{{hands.seen[1], hands.seen[0]}} : hands;
  own_hands_ = own.seen;
  detect(frame, exchanged ? with_sides_exchanged(seen) : seen, own, scene);
  lift(scene);
  choose(scene, chosen);
  sample_limbs(scene, chosen, samples_);
  fit_.run(scene, chosen, samples_, fitted_);
  update(frame, scene, chosen);
  learn(frame, scene);
}

void Body::predict(Scene& scene, double ticks) const {
  constexpr double kStartSigma_m = 0.12, kMostSigma_m = 0.3, kAstray = 2;
  const double seen_drift = left_after(ticks, kSeenDrift), hidden_drift = left_after(ticks, kHiddenDrift);
  Places ahead = fitted_.places;
  for (const JointId id : kFreeJoints) {
    const State& state = states_[id];
    const double drift = state.seen ? seen_drift : missed_ > 0 ? 1 : hidden_drift;
    ahead[id] = ahead[id] + drift * state.step;
  }
  // A hidden arm or leg goes along with the trunk.
  const TrunkAxes now = trunk_axes(fitted_.places), next = trunk_axes(ahead);
  for (const auto& limbs : {kArmChains, kLegChains})
    for (const Limb& limb : limbs)
      for (const JointId id : {limb[1], limb[2], limb[3]})
        if (const State& state = states_[id]; state.hidden > 0 && missed_ == 0)
          ahead[id] = next.in_rig(now.of(fitted_.places[id])) + hidden_drift * (state.step - pace_);
  for (const JointId id : kFreeJoints) {
    const State& state = states_[id];
    Expected& expected = scene.expected[id];
    expected.p = ahead[id];
    // It goes astray like a random walk.
    const double unrest = unrest_m(id) * (1 + 0.5 * std::min(missed_, 10.0));
    expected.sigma_m = std::min(unrest * std::sqrt(square(ticks) + kAstray * state.hidden), kMostSigma_m);
    if (age_ == 0) expected.sigma_m = kStartSigma_m;
    expected.hidden = state.hidden;
  }
}

void Body::detect(const FrameView& frame, const SeenBody& seen, const Hands& hands, Scene& scene) {
  constexpr double kMostStep_m = 0.06, kGate_m = 0.35;
  // Of the shoulders' width. Chosen on the four shared clips and on synthetic ones of seeds 501 and 502.
  constexpr double kAhead = 0.07;
  const double found =
      trunk_depth(frame.depth, corners_of(seen), {std::max(trunk_z_m_ - kGate_m, kNear_m), trunk_z_m_ + kGate_m});
  const double most_m = kMostStep_m * (frame.ticks() + missed_);
  if (found > 0) trunk_z_m_ += std::clamp(found - trunk_z_m_, -most_m, most_m);
  scene.trunk_z_m = trunk_z_m_;
  is_flat_ = !stands_out(frame.depth, corners_of(seen));
  region_ = seen.next;
  region_from_px_ = centre_of(corners_of(seen));
  color_.learn(color_of(frame, corners_of(seen)), frame.ticks());
  const double px_per_m = frame.depth.px_per_m(trunk_z_m_);
  scene.across = across_of(seen, expected_trunk());
  // From the side hips and head are marked ahead of their centres.
  const double width_m = lengths_[Bone::kShoulders], ahead_m = kAhead * width_m * scene.across.shoulders.z;
  scene.points = points_of(seen, frame.model, frame.picture.size(), px_per_m, width_m, ahead_m, hip_mark_.low_m());
  scene.lifted = {lifted(seen, true, px_per_m * width_m), lifted(seen, false, px_per_m * width_m)};
  leg_sides_.put_right(scene, frame.ticks());
  for (const JointId id : kFreeJoints)
    if (frame.is_covered(scene.points[id].at_px)) scene.points[id].hide();
  for (const bool left : {true, false}) detect_hand(frame, hands.seen[left ? 0 : 1], left, scene);
  Places expected = fitted_.places;
  for (const JointId id : kFreeJoints) expected[id] = scene.expected[id].p;
  scene.trunk = trunk_axes(expected);
  for (const Limb& arm : kArmChains) leave_upper_arm(scene, arm);
}

void Body::detect_hand(const FrameView& frame, const SeenHand* hand, bool left, Scene& scene) {
  const std::size_t side = left ? 0 : 1;
  const JointId wrist_id = left ? JointId::kLeftWrist : JointId::kRightWrist;
  if (hand != nullptr) {
    const bool is_there =
        belongs(*hand, scene.points[wrist_id], frame.depth.px_per_m(std::max(fitted_.places[wrist_id].z, kNear_m)));
    sight_[side] = is_there ? HandSight::kSeen : HandSight::kAbsent;
    if (is_there) hand_shift_[side] = take_hand(*hand, left, scene.points);
  } else if (sight_[side] == HandSight::kSeen) {
    take_shift(hand_shift_[side], left, scene.points);
  }
  scene.hands[side] = sight_[side];
  if (hand == nullptr) sight_[side] = HandSight::kNotAsked;  // an answer lasts for one frame more
  constexpr double kBeyond = 1.1;                            // fingers lie beyond the palm's centre
  const Vec2 palm = scene.points[left ? JointId::kLeftHand : JointId::kRightHand].at_px, wrist = scene.points[wrist_id].at_px;
  const Vec2 end = {wrist.x + kBeyond * (palm.x - wrist.x), wrist.y + kBeyond * (palm.y - wrist.y)};
  if (!(end.x >= 0 && end.y >= 0 && end.x < frame.picture.width() && end.y < frame.picture.height()))
    scene.hands[side] = HandSight::kOutside;
}

void Body::lift(Scene& scene) const {
  const DepthRange range = around(trunk_z_m_);
  for (const JointId id : kFreeJoints)
    if (scene.points[id].inside)
      scene.surfaces[id] =
          surfaces_at(scene.depth, scene.points[id].at_px, std::max(scene.expected[id].p.z, kNear_m), half_window_m(id), range);
  mark_what_hides(scene);
}

void Body::update(const FrameView& frame, const Scene& scene, const Choices& chosen) {
  constexpr double kStepGain = 0.5, kFar_off_m = 0.12, kFar_off_px = 6, kTooFar_m = 0.15;
  constexpr double kLongestStep_m = 0.2;       // per tick
  constexpr double kShown = 1, kUnsurely = 5;  // ticks
  constexpr double kMostOnBack = 12;           // ticks, by which three sigma reach over the whole back
  int inside = 0, looked_at = 0, showing = 0, seen_there = 0, seen = 0;
  ++age_;
  const double ticks = age_ == 1 ? 1 : frame.ticks();  // before the first frame nothing was hidden for long
  const double seen_drift = left_after(ticks, kSeenDrift), hidden_drift = left_after(ticks, kHiddenDrift);
  const double gain = gain_over(ticks, kStepGain), longest_m = kLongestStep_m * ticks;
  for (const JointId id : kFreeJoints) {
    State& state = states_[id];
    const Vec3 p = fitted_.places[id];
    const Vec2 at = frame.depth.geometry->project(p);
    const Point& point = scene.points[id];
    const std::size_t side = is_left(id) ? 0 : 1;
    state.hidden_by_limb = (is_hand_or_wrist(id) && scene.hands[side] != HandSight::kSeen &&
                            is_end_on(fitted_.places, kArmChains[side], lengths_)) ||
                           (is_hip(id) && is_behind_thigh(fitted_.places, kLegChains[side], lengths_));
    state.seen = chosen[id].on_surface && point.inside && std::abs(p.z - chosen[id].p.z) < kFar_off_m &&
                 distance(at, point.at_px) < std::max(kFar_off_px * point.sigma_px, kTooFar_m * frame.depth.px_per_m(p.z));
    inside += point.inside;
    const bool looked = point.inside && frame.is_matched(point.at_px) && !frame.is_covered(point.at_px);
    const bool shows = looked && !scene.surfaces[id].is_hidden();
    looked_at += looked, showing += shows, seen_there += shows && state.seen;
    seen += state.seen;
    const bool was_hidden = state.hidden > 2;
    state.shown = !state.seen ? -1 : state.shown < 0 ? 0 : state.shown + ticks;
    // After a gap one sight may be a mistake, and more of a hand or wrist at which the network of hands did not look; where it
    // looked and saw none, they are not believed again.
    const HandSight sight = is_hand_or_wrist(id) ? scene.hands[side] : HandSight::kSeen;
    const bool on_back = scene.off_back_m(id, p).has_value();
    const double enough = sight == HandSight::kSeen ? kShown : kUnsurely;
    const bool believed = state.sure || age_ == 1 || (sight != HandSight::kAbsent && state.shown >= enough);
    state.sure = state.seen && !state.hidden_by_limb && !on_back && believed && frame.shows(point.at_px) && frame.shows(at);
    state.absent = sight == HandSight::kAbsent;
    state.hidden = state.seen ? 0 : state.hidden + ticks;
    state.astray = state.seen ? 0 : state.astray + ticks;
    if (on_back) state.astray = std::min(state.astray, kMostOnBack);
    const Vec3 off = p - scene.expected[id].p;
    // What the network guesses of a hidden limb tells nothing of its speed.
    if (was_hidden && state.seen)
      state.step = {};
    else if (state.seen || is_root(id))
      state.step = (state.seen ? seen_drift : hidden_drift) * state.step + gain * off;
    else
      state.step = pace_ + hidden_drift * (state.step - pace_);
    if (const double now = norm(state.step); now > longest_m) state.step = (longest_m / now) * state.step;
  }
  seen_share_.reset();
  if (showing > 0 && 2 * looked_at >= inside) seen_share_ = static_cast<double>(seen_there) / showing;
  missed_ = seen > 0 ? 0 : missed_ + ticks;
  learn_pace(ticks);
}

// Who walks behind somebody walks on.
void Body::miss(const FrameView& frame, bool covered) {
  const double keeps = left_after(frame.ticks(), covered ? 0.97 : 0.8);
  missed_ += frame.ticks();
  seen_share_.reset();
  own_hands_ = {};
  trunk_z_m_ += pace_.z;
  for (const JointId id : kFreeJoints) {
    State& state = states_[id];
    fitted_.places[id] = fitted_.places[id] + pace_;
    state.step = keeps * pace_;
    state.seen = state.sure = false;
    state.shown = -1;
    state.hidden += frame.ticks();
    state.astray += frame.ticks();
  }
  pace_ = keeps * pace_;
  complete(fitted_.places);
}

std::optional<TurnedSquare> Body::hand_region(const FrameView& frame, const SeenBody& seen, bool left) const {
  constexpr double kLeastHand_px = 36, kHand_m = 0.18, kHalf_m = 0.15, kBeyond_m = 0.085;
  using enum BodyPoint;
  const auto at = [&](BodyPoint point) { return Vec2{seen.at(point).x_px(), seen.at(point).y_px()}; };
  const JointId wrist_id = left ? JointId::kLeftWrist : JointId::kRightWrist;
  const double z = std::max(fitted_.places[wrist_id].z + states_[wrist_id].step.z, kNear_m);
  const double px_per_m = frame.depth.px_per_m(z);
  if (px_per_m * kHand_m < kLeastHand_px) return std::nullopt;
  const Vec2 wrist = at(left ? kLeftWrist : kRightWrist), elbow = at(left ? kLeftElbow : kRightElbow);
  const Vec2 knuckles = mean(at(left ? kLeftIndex : kRightIndex), at(left ? kLeftPinky : kRightPinky));
  const auto unit = [](Vec2 from, Vec2 to) {
    const double n = std::max(distance(from, to), 1e-6);
    return Vec2{(to.x - from.x) / n, (to.y - from.y) / n};
  };
  const Vec2 hand = unit(wrist, knuckles), fore = unit(elbow, wrist);
  const Vec2 along = unit({0, 0}, {0.6 * hand.x + 0.4 * fore.x, 0.6 * hand.y + 0.4 * fore.y});
  const double beyond = kBeyond_m * px_per_m, half = kHalf_m * px_per_m;
  const Vec2 centre = {wrist.x + beyond * along.x, wrist.y + beyond * along.y};
  if (!(centre.x >= 0 && centre.y >= 0 && centre.x < frame.picture.width() && centre.y < frame.picture.height()))
    return std::nullopt;
  const auto q8 = [](double px) { return static_cast<std::int32_t>(std::lround(256 * px)); };
  return TurnedSquare{q8(centre.x), q8(centre.y), q8(-along.y * half), q8(along.x * half)};
}

void Body::publish(const FrameView& frame, Person& person) const {
  using enum JointId;
  // Equations know nothing of what is wrong in the same way in all frames. Hips are marked higher or lower on one person than
  // on another.
  constexpr double kScale = 1.4, kHandScale = 1.15, kFloor_m = 0.006, kHipMark_m = 0.028, kLost_m = 0.45, kHandLost_m = 0.37,
                   kHeld_m = 0.07, kAbsent_m = 0.08;
  const Places places = with_lengths(fitted_.places, lengths_);
  const auto fill = [&](JointId id, Vec3 p, const Covariance3& c, JointState state, Vec3 step) {
    Joint& joint = person.joints[index_of(id)];
    joint.p_in_rig_m = p;
    const bool hand = is_hand_or_wrist(id);
    const double k = square(hand ? kHandScale : kScale), floor = square(kFloor_m);
    const double mark = is_hip(id) ? square(kHipMark_m) : 0;
    joint.cov_m2 = {k * c.xx + floor, k * c.xy, k * c.xz, k * c.yy + floor + mark, k * c.yz, k * c.zz + floor};
    if (age_ > 1) joint.v_in_rig_m_s = (1 / frame.frame_s) * step;  // what the first fit corrects is no speed
    joint.state = joint.sigma_m() > (hand ? kHandLost_m : kLost_m) ? JointState::kLost : state;
    joint.confidence = joint.state == JointState::kLost ? 0 : 1 / (1 + square(joint.sigma_m() / 0.1));
  };
  for (const JointId id : kFreeJoints) {
    const State& state = states_[id];
    Covariance3 c = fitted_.covariance[id];
    if (!state.sure) {
      const bool held = is_root(id) && missed_ == 0;  // by the rest of the trunk
      // A surface is no proof of a hand where its network saw none.
      const double least_m = state.absent ? kAbsent_m : 0.035;
      const double grown =
          square(std::clamp(0.035 + 0.25 * std::min(state.astray, 30.0) * kTick_s, least_m, held ? kHeld_m : 1));
      c.xx += grown;
      c.yy += grown;
      c.zz += grown;
    }
    fill(id, places[id], c, state.sure ? JointState::kSeen : JointState::kInferred, state.step);
  }
  const auto between = [&](JointId id, JointId a, JointId b) {
    const Covariance3 &ca = person.joints[index_of(a)].cov_m2, &cb = person.joints[index_of(b)].cov_m2;
    const Covariance3 c = {(ca.xx + cb.xx) / 4, 0, 0, (ca.yy + cb.yy) / 4, 0, (ca.zz + cb.zz) / 4};
    const Vec2 at = frame.depth.geometry->project({places[id].x, places[id].y, std::max(places[id].z, kNear_m)});
    const bool seen = (states_[a].sure || states_[b].sure) && frame.shows(at);
    fill(id, places[id], c, seen ? JointState::kSeen : JointState::kInferred, 0.5 * (states_[a].step + states_[b].step));
  };
  between(kPelvis, kLeftHip, kRightHip);
  between(kSpine, kLeftHip, kRightHip);
  between(kChest, kLeftShoulder, kRightShoulder);
  between(kNeck, kLeftShoulder, kRightShoulder);
}

}  // namespace duo::body
