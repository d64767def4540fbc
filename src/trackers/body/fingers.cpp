#include "trackers/body/fingers.h"

#include <algorithm>
#include <cmath>

#include "duoptic/statistics.h"

namespace duo::body {
namespace {

constexpr std::array<std::size_t, 5> kPalm = {0, 5, 9, 13, 17};  // wrist and knuckles
/// From the skin to a joint's centre, by how far it is from its finger's root; the wrist first.
constexpr std::array<double, 1 + kJointsPerFinger> kFlesh_m = {0.02, 0.013, 0.010, 0.008, 0.007};
constexpr double kFingerDepth_px = 0.35;  // one standard deviation of a surface

double flesh_m(std::size_t point) { return point == 0 ? kFlesh_m[0] : kFlesh_m[1 + (point - 1) % kJointsPerFinger]; }

/// How far behind the palm the network imagines each point, as large as the hand is in the picture.
std::array<double, kHandPoints> behind_palm_m(const Rectified& geometry, const SeenHand& hand, double z_m) {
  constexpr double kLeastScale = 0.7, kMostScale = 1.3;
  Vec2 middle_px;
  Vec3 middle_m;
  for (const SeenPoint& point : hand.points) {
    middle_px = {middle_px.x + point.x_px() / kHandPoints, middle_px.y + point.y_px() / kHandPoints};
    middle_m = middle_m + (1.0 / kHandPoints) * point.world_m();
  }
  double spread_px = 0, spread_m = 0;
  for (const SeenPoint& point : hand.points) {
    const Vec3 off = point.world_m() - middle_m;
    spread_px += square(point.x_px() - middle_px.x) + square(point.y_px() - middle_px.y);
    spread_m += square(off.x) + square(off.y);
  }
  const double scale =
      std::clamp(std::sqrt(spread_px / std::max(spread_m, 1e-6)) * z_m / geometry.focal_px, kLeastScale, kMostScale);
  // The network takes itself to look along the hand's ray.
  const Vec3 ray = normalized(geometry.unproject(middle_px, 1)), x = normalized(Vec3{ray.z, 0, -ray.x}), y = cross(ray, x);
  std::array<double, kHandPoints> out;
  double palm = 0;
  for (std::size_t i = 0; i < kHandPoints; ++i) {
    const Vec3 w = hand.points[i].world_m();
    out[i] = scale * (w.x * x.z + w.y * y.z + w.z * ray.z);
  }
  for (const std::size_t i : kPalm) palm += out[i] / kPalm.size();
  for (double& z : out) z -= palm;
  return out;
}

}  // namespace

std::optional<FingerPlaces> place_fingers(const FrameView& frame, const SeenHand& hand, double hand_z_m) {
  constexpr double kHalfWindow_m = 0.01, kReach_m = 0.2, kHand_m = 0.08, kClose_m = 0.025;
  constexpr double kShape_m = 0.014, kShapeShare = 0.25, kAcross_m = 0.01, kSkin_m = 0.01;
  const DepthView& depth = frame.depth;
  const double m_per_px = depth.m_per_px(hand_z_m), noise_m = kFingerDepth_px * m_per_px;
  const auto behind = behind_palm_m(*depth.geometry, hand, hand_z_m);
  const auto at = [&](std::size_t i) { return Vec2{hand.points[i].x_px(), hand.points[i].y_px()}; };
  std::array<Surfaces, kHandPoints> surfaces;
  const auto joint_z = [&](std::size_t i, const Surface& s) { return s.z_m + flesh_m(i) - DepthView::kThin_px * m_per_px; };
  /// The surface of a point that lies nearest to where its joint should be; null: it has none.
  const auto nearest = [&](std::size_t i, double z) -> const Surface* {
    const auto all = surfaces[i].get();
    const auto off = [&](const Surface& s) { return std::abs(joint_z(i, s) - z); };
    const auto best = std::ranges::min_element(all, {}, off);
    return best == all.end() ? nullptr : &*best;
  };
  // The palm's depth by all points.
  std::array<double, kHandPoints> palms;
  std::size_t count = 0;
  for (std::size_t i = 0; i < kHandPoints; ++i) {
    surfaces[i] = surfaces_at(depth, at(i), hand_z_m, kHalfWindow_m, {std::max(hand_z_m - kReach_m, 0.2), hand_z_m + kReach_m});
    const Surface* surface = nearest(i, hand_z_m + behind[i]);
    if (surface == nullptr) continue;
    const double palm = joint_z(i, *surface) - behind[i];
    if (std::abs(palm - hand_z_m) < kHand_m + noise_m) palms[count++] = palm;
  }
  if (count < kHandPoints / 3) return std::nullopt;
  const double palm_z = median(std::span(palms.data(), count));

  FingerPlaces out;
  for (std::size_t i = 1; i < kHandPoints; ++i) {
    double z = palm_z + behind[i], variance = square(kShape_m + kShapeShare * std::abs(behind[i])) + square(noise_m) / 4;
    const Surface* surface = nearest(i, z);
    const double close_m = kClose_m + noise_m;
    if (surface != nullptr && std::abs(joint_z(i, *surface) - z) < close_m) {
      const double measured = square(kSkin_m) + square(noise_m), share = variance / (variance + measured);
      z += share * (joint_z(i, *surface) - z);
      variance *= 1 - share;
      out.seen[i - 1] = frame.shows(at(i));
    }
    const Vec3 p = depth.geometry->unproject(at(i), z), ray = (1 / z) * p;
    const double across = square(kAcross_m);
    out.p[i - 1] = p;
    out.covariance[i - 1] = {across + variance * ray.x * ray.x, variance * ray.x * ray.y, variance * ray.x * ray.z,
                             across + variance * ray.y * ray.y, variance * ray.y * ray.z, variance * ray.z * ray.z};
  }
  return out;
}

void Fingers::track(const FrameView& frame, const SeenHand* hand, const Places& body) {
  const Vec3 wrist_now = body[wrist()];
  const double z = (wrist_now.z + body[left_ ? JointId::kLeftHand : JointId::kRightHand].z) / 2;
  if (const auto found = hand != nullptr ? place_fingers(frame, *hand, z) : std::nullopt) {
    found_ = *found;
    hidden_ = 0;
  } else {
    for (Vec3& p : found_.p) p = p + (wrist_now - wrist_);
    hidden_ = std::min(hidden_ + frame.ticks(), kMostHidden + 1);
  }
  wrist_ = wrist_now;
}

void Fingers::publish(Person& person) const {
  constexpr double kAstray_m = 0.015;  // per tick
  const Joint& at_wrist = person.joints[index_of(wrist())];
  for (std::size_t i = 0; i < kFingerJoints; ++i) {
    Joint& joint =
        person.joints[index_of(finger_joint(left_ ? Side::kLeft : Side::kRight, {i / kJointsPerFinger, i % kJointsPerFinger}))];
    joint = {};
    joint.p_in_rig_m = at_wrist.p_in_rig_m;
    if (hidden_ > kMostHidden || at_wrist.state == JointState::kLost) continue;
    const Covariance3& c = found_.covariance[i];
    const double grown = square(kAstray_m * hidden_);
    joint.p_in_rig_m = found_.p[i];
    joint.cov_m2 = {c.xx + grown, c.xy, c.xz, c.yy + grown, c.yz, c.zz + grown};
    joint.v_in_rig_m_s = at_wrist.v_in_rig_m_s;
    joint.state = hidden_ == 0 && found_.seen[i] ? JointState::kSeen : JointState::kInferred;
    joint.confidence = 1 / (1 + square(joint.sigma_m() / 0.1));
  }
}

}  // namespace duo::body
