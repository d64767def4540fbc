#include "trackers/body/candidates.h"

namespace duo::body {
namespace {

constexpr double kHidden = -2.5, kHiddenButVisible = -1.5, kHiddenButHandSeen = -4, kHandAbsent = -1, kHandOutside = -2.5,
                 kHandBehind = -3;
constexpr double kFreeSpace = -6, kIsTrunk = -7, kUnseen = -2, kUnseenArm = -5, kInTrunk = -4, kMostOffBack = 2;

/// About ln(share), without a library whose last bits differ from processor to processor.
double log_share(double share) { return 2 * (share - 1) / (share + 1) * 1.3; }

/// 0 up to `low`, 1 from `high` on.
double share_of(double value, double low, double high) { return std::clamp((value - low) / (high - low), 0.0, 1.0); }

double expected_score(const Expected& expected, Vec3 p, double most) {
  const double sigma = expected.sigma_m + 0.02;
  return capped(distance(expected.p, p), sigma, most / (1 + 0.5 * expected.hidden));
}

/// A hidden joint has something before it, and at least its own flesh.
double free_space_score(const Scene& scene, JointId id, Vec3 p) {
  constexpr double kClose_m = 0.03, kNoise_px = 0.25;
  const Surfaces& surfaces = scene.surfaces[id];
  if (surfaces.count == 0 || !scene.points[id].inside) return 0;
  const double skin_z = surfaces.all[0].z_m;
  const double flesh = depth_of_joint_m(scene, id, skin_z) - kNoise_px * scene.depth.m_per_px(p.z);
  return skin_z + std::max(flesh, 0.0) > p.z + kClose_m ? kFreeSpace : 0;
}

/// A hidden arm is behind the trunk or beside it, not in it.
double inside_trunk_score(const Scene& scene, JointId id, Vec3 p) {
  if (!is_arm(id)) return 0;
  const auto height = scene.map->height_m(scene.trunk, p, scene.width_m());
  if (!height) return 0;
  const Vec3 q = scene.trunk.of(p);
  const double above = q.z, behind = default_height_m(scene.trunk, q.y, scene.width_m());
  const bool front = dot(scene.trunk.front, scene.trunk.shoulders) < 0;
  return front ? (above < *height && above > -behind ? kInTrunk : 0) : (above > *height && above < behind ? kInTrunk : 0);
}

/// The length of a bone alone leaves the depth of a hidden hand open: its forearm, taken for a tenth too long, points away from
/// the cameras by half of its length.
double off_back_score(const Scene& scene, JointId id, Vec3 p) {
  const auto off = scene.off_back_m(id, p);
  return off ? capped(*off, kBackSigma_m, kMostOffBack) : 0;
}

double hidden_score(const Scene& scene, JointId id) {
  double score = kHidden;
  score += kHiddenButVisible * share_of(scene.points[id].visibility, 0.6, 0.95);
  if (is_hand_or_wrist(id) && scene.sight_of(id) == HandSight::kSeen) score += kHiddenButHandSeen;
  return score;
}

/// How likely a surface over the trunk is the trunk's own, 0 .. 1.
double trunk_share(const Scene& scene, JointId id, double skin_z) {
  constexpr double kProud_m = 0.025, kArmProud_m = 0.08, kBelow_m = 0.04, kBeforePlane_m = 0.08, kNoise_px = 0.25;
  if (!is_arm(id)) return 0;
  const HandSight hand = scene.hands[is_left(id) ? 0 : 1];
  const bool elbow = id == JointId::kLeftElbow || id == JointId::kRightElbow;
  if (hand == HandSight::kSeen && !elbow) return 0;
  const Vec3 skin = on_ray(scene, id, skin_z);
  const auto height = scene.map->height_m(scene.trunk, skin, scene.width_m());
  if (!height) return 0;
  const bool front = dot(scene.trunk.front, scene.trunk.shoulders) < 0;
  const double above = scene.trunk.of(skin).z, proud = front ? above - *height : *height - above;
  const double noise = kNoise_px * scene.depth.m_per_px(skin_z);
  if (hand == HandSight::kAbsent && !elbow && proud > -kBelow_m &&
      ((front ? above : -above) < kBeforePlane_m || proud < kArmProud_m))
    return 1;
  if (proud > kProud_m + noise || proud < -kBelow_m - noise) return 0;
  // Of an elbow beside the trunk the network knows whether it is seen; of a hand behind the back it does not.
  return elbow ? 1 - share_of(scene.points[id].visibility, 0.6, 0.85) : 1;
}

/// What the network of hands says against a hand at a place on a surface. Behind the back, the network of bodies marks a hand
/// where its arm goes in: what is seen there is the forearm.
double sight_score(const Scene& scene, JointId id, Vec3 p) {
  const bool hand = id == JointId::kLeftHand || id == JointId::kRightHand;
  const bool wrist = id == JointId::kLeftWrist || id == JointId::kRightWrist;
  if (!hand && !wrist) return 0;
  const HandSight sight = scene.sight_of(id);
  if (sight == HandSight::kOutside && hand) return kHandOutside;
  if (sight != HandSight::kAbsent) return 0;
  return hand && scene.off_back_m(id, p) ? kHandAbsent + kHandBehind : kHandAbsent;
}

/// What is on a surface is seen, and of arms that are hidden the network knows that they are: of those that it called visible
/// with less than 0.2, 3 % were where a surface was, and nearly all that were chosen to be on one were not. That is the full
/// network, on the shared clips and synthetic ones of seeds 501 and 502; the lite one gains nothing by it, and loses little.
double unseen_score(const Scene& scene, JointId id) {
  const double visibility = scene.points[id].visibility;
  const double score = kUnseen * (1 - share_of(visibility, 0.35, 0.7));
  const bool hand_seen = is_hand_or_wrist(id) && scene.sight_of(id) == HandSight::kSeen;
  return is_arm(id) && !hand_seen ? score + kUnseenArm * (1 - share_of(visibility, 0.15, 0.3)) : score;
}

/// Whether a place on a surface is on somebody else, who stands before this person, and is not where the joint is expected.
bool is_of_another(const Scene& scene, JointId id, Vec3 skin) {
  constexpr double kOwn_m = 0.12;
  if (scene.nearer.empty() || distance(scene.expected[id].p, skin) < kOwn_m) return false;
  return std::ranges::any_of(scene.nearer, [&](const Places* other) {
    return std::ranges::any_of(kBody.joints, [&](const JointDef& joint) {
      if (joint.parent < 0) return false;
      const JointId from = kBody.joints[static_cast<std::size_t>(joint.parent)].id;
      return to_segment(skin, (*other)[from], (*other)[joint.id]) < joint.radius_m;
    });
  });
}

}  // namespace

double length_score(const Scene& scene, Bone bone, Vec3 a, Vec3 b) {
  constexpr double kLengthSigma_m = 0.025, kMostLength = 6;
  const double sigma =
      kLengthSigma_m + scene.lengths->sigma_m(bone) + 0.3 * scene.depth.m_per_px(std::max(b.z, 0.3)) * kDepthSigma_px;
  return capped(distance(a, b) - (*scene.lengths)[bone], sigma, kMostLength);
}

Vec3 on_ray(const Scene& scene, JointId id, double z) {
  return scene.depth.geometry->unproject(scene.points[id].at_px, std::max(z, 0.2));
}

double z_sigma_m(const Scene& scene, double z) {
  constexpr double kRadiusSigma_m = 0.012;
  return std::sqrt(square(kRadiusSigma_m) + square(kDepthSigma_px * scene.depth.m_per_px(z)));
}

void add_surfaces(const Scene& scene, JointId id, double most_expected, Candidates& out) {
  bool nearer = false;  // something before the trunk was met
  for (const Surface& surface : scene.surfaces[id].get()) {
    if (surface.hides) continue;
    Candidate c;
    c.p = on_ray(scene, id, surface.z_m + depth_of_joint_m(scene, id, surface.z_m));
    c.skin_z_m = surface.z_m;
    c.score = log_share(surface.share) +
              expected_score(scene.expected[id], c.p, most_expected / (1 + 0.5 * scene.expected[id].hidden));
    c.score += sight_score(scene, id, c.p) + unseen_score(scene, id);
    if (is_of_another(scene, id, on_ray(scene, id, surface.z_m))) c.score += kSameSurface;
    if (const double trunk = trunk_share(scene, id, surface.z_m); trunk > 0) {
      if (nearer) continue;
      c.doubtful = trunk > 0.5;
      c.score += trunk * kIsTrunk;
    } else {
      nearer = true;
    }
    out.add(c);
  }
}

void add_hidden(const Scene& scene, JointId id, Vec3 p, double most_expected, Candidates& out) {
  out.add({p,
           hidden_score(scene, id) + free_space_score(scene, id, p) + inside_trunk_score(scene, id, p) +
               off_back_score(scene, id, p) + expected_score(scene.expected[id], p, most_expected),
           0, false});
}

void add_sphere(const Scene& scene, JointId id, Vec3 parent, double length, double most, Candidates& out) {
  const Vec3 ray = on_ray(scene, id, 1);
  const double a = dot(ray, ray), b = dot(ray, parent), c = dot(parent, parent) - square(length), root = b * b - a * c;
  if (root < 0) {
    add_hidden(scene, id, parent + (length / std::max(distance((b / a) * ray, parent), 1e-6)) * ((b / a) * ray - parent), most,
               out);
    return;
  }
  for (const double sign : {-1.0, 1.0}) {
    const double z = (b + sign * std::sqrt(root)) / a;
    if (z > 0.2) add_hidden(scene, id, z * ray, most, out);
  }
}

// Source  chosen on three of the shared clips; those of hips, and kHeadFlat_m below, anew on all four and synthetic ones of
// seeds 501 and 502 (docs/measurements.md).
double depth_of_joint_m(JointId id, double width_m, double away) {
  using enum JointId;
  switch (id) {
    case kLeftShoulder:
    case kRightShoulder:
      return 0.185 * width_m + 0.045 * away;
    case kLeftHip:
    case kRightHip:
      return 0.34 * width_m + 0.03 * away;
    case kHead:
      return 0.104;
    case kLeftElbow:
    case kRightElbow:
      return 0.051;
    case kLeftWrist:
    case kRightWrist:
      return 0.021;
    case kLeftHand:
    case kRightHand:
      return 0.013;
    case kLeftKnee:
    case kRightKnee:
      return 0.068;
    case kLeftAnkle:
    case kRightAnkle:
      return 0.054;
    default:
      return 0.04;
  }
}

double depth_of_joint_m(const Scene& scene, JointId id, double skin_z) {
  constexpr double kLiftedFlat = 0.035;  // of the width: shoulders of lifted arms lie nearer to their skin
  constexpr double kHeadFlat_m = 0.02;   // nearer to its skin from the side
  const double line = is_hip(id) ? scene.across.hips.z : scene.across.shoulders.z;
  double behind = depth_of_joint_m(id, scene.width_m(), is_left(id) ? line : -line);
  if (is_shoulder(id)) behind -= kLiftedFlat * scene.width_m() * scene.lifted[is_left(id) ? 0 : 1];
  if (id == JointId::kHead) behind -= kHeadFlat_m * square(line);
  return is_hip(id) || is_shoulder(id) ? behind : behind - DepthView::kThin_px * scene.depth.m_per_px(skin_z);
}

double half_window_m(JointId id) {
  using enum JointId;
  switch (id) {
    case kLeftWrist:
    case kRightWrist:
    case kLeftHand:
    case kRightHand:
      return 0.035;
    default:
      return 0.05;
  }
}

}  // namespace duo::body
