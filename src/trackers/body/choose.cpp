#include "trackers/body/choose.h"

#include <algorithm>
#include <span>

namespace duo::body {
namespace {

// Scores are log likelihoods, up to a constant.
constexpr double kHidden = -2.5, kHiddenButVisible = -1.5, kHiddenButHandSeen = -4, kHandAbsent = -1, kHandOutside = -2.5;
constexpr double kFreeSpace = -6, kIsTrunk = -7, kUnseen = -2, kInTrunk = -4, kSameSurface = -6;
constexpr double kLengthSigma_m = 0.025, kMostLength = 6, kMostExpectedRoot = 12, kMostExpected = 4, kMostExpectedEnd = 3;
constexpr double kDepthSigma_px = 0.35;

struct Candidate {
  Vec3 p;
  double score = 0;
  double skin_z_m = 0;    // of its surface; 0: hidden
  bool doubtful = false;  // its surface may be the trunk's

  bool hidden() const { return skin_z_m == 0; }
};

struct Candidates {
  std::array<Candidate, 24> all = {};
  std::size_t count = 0;
  void add(const Candidate& candidate) {
    if (count < all.size()) all[count++] = candidate;
  }
  std::span<const Candidate> get() const { return {all.data(), count}; }
};

/// About ln(share), without a library whose last bits differ from processor to processor.
double log_share(double share) { return 2 * (share - 1) / (share + 1) * 1.3; }

/// 0 up to `low`, 1 from `high` on.
double share_of(double value, double low, double high) { return std::clamp((value - low) / (high - low), 0.0, 1.0); }

double capped(double distance, double sigma, double most) { return -std::min(square(distance / sigma) / 2, most); }

double expected_score(const Expected& expected, Vec3 p, double most) {
  const double sigma = expected.sigma_m + 0.02;
  return capped(distance(expected.p, p), sigma, most / (1 + 0.5 * expected.hidden));
}

double length_score(const Scene& scene, Bone bone, Vec3 a, Vec3 b) {
  const double sigma =
      kLengthSigma_m + scene.lengths->sigma_m(bone) + 0.3 * scene.depth.m_per_px(std::max(b.z, 0.3)) * kDepthSigma_px;
  return capped(distance(a, b) - (*scene.lengths)[bone], sigma, kMostLength);
}

Vec3 on_ray(const Scene& scene, JointId id, double z) {
  return scene.depth.geometry->unproject(scene.points[id].at_px, std::max(z, 0.2));
}

bool is_arm(JointId id) {
  return (id >= JointId::kLeftElbow && id <= JointId::kLeftHand) || (id >= JointId::kRightElbow && id <= JointId::kRightHand);
}

/// A hidden joint has something before it.
double free_space_score(const Scene& scene, JointId id, Vec3 p) {
  constexpr double kClose_m = 0.03;
  const Surfaces& surfaces = scene.surfaces[id];
  if (surfaces.count == 0 || !scene.points[id].inside) return 0;
  return surfaces.all[0].z_m > p.z + kClose_m ? kFreeSpace : 0;
}

/// A hidden arm is behind the trunk or beside it, not in it.
double inside_trunk_score(const Scene& scene, JointId id, Vec3 p) {
  constexpr double kBehindPlane_m = 0.24;  // of the shoulders' width
  if (!is_arm(id)) return 0;
  const auto height = scene.map->height_m(scene.trunk, p, scene.width_m());
  if (!height) return 0;
  const double above = scene.trunk.of(p).z, behind = kBehindPlane_m * scene.width_m();
  const bool front = dot(scene.trunk.front, scene.trunk.shoulders) < 0;
  return front ? (above < *height && above > -behind ? kInTrunk : 0) : (above > *height && above < behind ? kInTrunk : 0);
}

double hidden_score(const Scene& scene, JointId id) {
  double score = kHidden;
  score += kHiddenButVisible * share_of(scene.points[id].visibility, 0.6, 0.95);
  const bool left = is_left(id);
  const bool of_hand =
      id == JointId::kLeftHand || id == JointId::kRightHand || id == JointId::kLeftWrist || id == JointId::kRightWrist;
  if (of_hand && scene.hands[left ? 0 : 1] == HandSight::kSeen) score += kHiddenButHandSeen;
  return score;
}

/// How likely a surface over the trunk is the trunk's own, 0 .. 1.
double trunk_share(const Scene& scene, JointId id, double skin_z) {
  constexpr double kProud_m = 0.025, kBelow_m = 0.04, kBeforePlane_m = 0.08, kNoise_px = 0.25;
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
  if (hand == HandSight::kAbsent && !elbow && proud > -kBelow_m && (front ? above : -above) < kBeforePlane_m) return 1;
  if (proud > kProud_m + noise || proud < -kBelow_m - noise) return 0;
  // Of an elbow beside the trunk the network knows whether it is seen; of a hand behind the back it does not.
  return elbow ? 1 - share_of(scene.points[id].visibility, 0.6, 0.85) : 1;
}

double z_sigma_m(const Scene& scene, const Candidate& c) {
  constexpr double kRadiusSigma_m = 0.012;
  return std::sqrt(square(kRadiusSigma_m) + square(kDepthSigma_px * scene.depth.m_per_px(c.p.z)));
}

Choice choice_of(const Scene& scene, const Candidate& c) {
  const bool on = !c.hidden() && !c.doubtful;
  return {c.p, on, on ? z_sigma_m(scene, c) : 0};
}

/// What the network of hands says against a hand on a surface.
double sight_score(const Scene& scene, JointId id) {
  const bool hand = id == JointId::kLeftHand || id == JointId::kRightHand;
  const bool wrist = id == JointId::kLeftWrist || id == JointId::kRightWrist;
  if (!hand && !wrist) return 0;
  const HandSight sight = scene.hands[is_left(id) ? 0 : 1];
  if (sight == HandSight::kOutside && hand) return kHandOutside;
  return sight == HandSight::kAbsent ? kHandAbsent : 0;
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

void add_surfaces(const Scene& scene, JointId id, double most_expected, Candidates& out) {
  bool nearer = false;  // something before the trunk was met
  for (const Surface& surface : scene.surfaces[id].get()) {
    Candidate c;
    c.p = on_ray(scene, id, surface.z_m + depth_of_joint_m(scene, id, surface.z_m));
    c.skin_z_m = surface.z_m;
    c.score = log_share(surface.share) +
              expected_score(scene.expected[id], c.p, most_expected / (1 + 0.5 * scene.expected[id].hidden));
    c.score += sight_score(scene, id) + kUnseen * (1 - share_of(scene.points[id].visibility, 0.35, 0.7));
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
               expected_score(scene.expected[id], p, most_expected),
           0, false});
}

/// The best pair of left and right at the ends of a line across the trunk.
void choose_line(const Scene& scene, JointId left, JointId right, Bone bone, Vec3 across, Choices& out) {
  const double width = (*scene.lengths)[bone];
  std::array<Candidates, 2> sides;
  const std::array<JointId, 2> ids = {left, right};
  for (std::size_t s = 0; s < 2; ++s) add_surfaces(scene, ids[s], kMostExpectedRoot, sides[s]);
  const std::array<std::size_t, 2> on_surface = {sides[0].count, sides[1].count};
  for (std::size_t s = 0; s < 2; ++s) {
    const double sign = s == 0 ? 1 : -1;
    for (std::size_t i = 0; i < on_surface[1 - s]; ++i)
      add_hidden(scene, ids[s], on_ray(scene, ids[s], sides[1 - s].all[i].p.z + sign * width * across.z), kMostExpectedRoot,
                 sides[s]);
    add_hidden(scene, ids[s], on_ray(scene, ids[s], scene.expected[ids[s]].p.z), kMostExpectedRoot, sides[s]);
  }
  // Head on, depth tells how the line is turned; from the side the network does.
  const double turned = std::min(std::abs(across.z), 1.0);
  const double line_sigma = width * (0.35 - 0.17 * turned) + 0.3 * scene.depth.m_per_px(scene.trunk_z_m) * kDepthSigma_px;
  double best = -1e9;
  for (const Candidate& a : sides[0].get())
    for (const Candidate& b : sides[1].get()) {
      const double score =
          a.score + b.score + length_score(scene, bone, a.p, b.p) + capped(a.p.z - b.p.z - width * across.z, line_sigma, 8);
      if (score <= best) continue;
      best = score;
      out[left] = choice_of(scene, a);
      out[right] = choice_of(scene, b);
    }
}

struct LimbBones {
  std::array<Bone, 3> bones;
  double most_middle, most_end;
};
constexpr LimbBones kArmBones = {{Bone::kUpperArm, Bone::kForearm, Bone::kPalm}, kMostExpected, kMostExpectedEnd};
constexpr LimbBones kLegBones = {{Bone::kThigh, Bone::kShin, Bone::kFoot}, kMostExpected, kMostExpected};

struct LimbChoice {
  double score = -1e9;
  std::array<Candidate, 3> joints;
};

bool same_surface(const Candidate& a, const Candidate& b) {
  constexpr double kSame_m = 0.05;
  return !a.hidden() && !b.hidden() && distance(a.p, b.p) < kSame_m;
}

/// Surfaces that the other limb stands on: of its joints, and between those that are seen.
struct Taken {
  Choice root;
  std::span<const Candidate> joints = {};

  bool has(const Scene& scene, const Candidate& c) const {
    const double close_m = 0.04 + 0.3 * scene.depth.m_per_px(c.p.z);
    Vec3 from = root.p;
    bool from_seen = root.on_surface;
    for (const Candidate& to : joints) {
      if (same_surface(c, to)) return true;
      if (!c.hidden() && from_seen && !to.hidden() && to_segment(c.p, from, to.p) < close_m) return true;
      from = to.p;
      from_seen = !to.hidden();
    }
    return false;
  }
};

/// Places on a joint's ray that lie a bone's length from its parent.
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

LimbChoice choose_limb(const Scene& scene, const Limb& limb, const LimbBones& bones, Vec3 root, const Taken& taken) {
  std::array<Candidates, 3> nodes;
  for (std::size_t n = 0; n < 3; ++n) {
    const JointId id = limb[n + 1];
    const double most = n == 2 ? bones.most_end : bones.most_middle;
    add_surfaces(scene, id, most, nodes[n]);
    for (std::size_t i = 0; i < nodes[n].count; ++i)
      if (taken.has(scene, nodes[n].all[i])) nodes[n].all[i].score += kSameSurface;
    add_hidden(scene, id, on_ray(scene, id, scene.expected[id].p.z), most, nodes[n]);
    add_hidden(scene, id, scene.expected[id].p, most, nodes[n]);
    if (n == 0) {
      add_sphere(scene, id, root, (*scene.lengths)[bones.bones[0]], most, nodes[0]);
    } else {
      const std::size_t parents = std::min<std::size_t>(nodes[n - 1].count, 7);
      for (std::size_t i = 0; i < parents; ++i)
        add_sphere(scene, id, nodes[n - 1].all[i].p, (*scene.lengths)[bones.bones[n]], most, nodes[n]);
    }
  }
  std::array<std::array<double, 24>, 3> best;
  std::array<std::array<std::size_t, 24>, 3> from = {};
  for (std::size_t i = 0; i < nodes[0].count; ++i)
    best[0][i] = nodes[0].all[i].score + length_score(scene, bones.bones[0], root, nodes[0].all[i].p);
  for (std::size_t n = 1; n < 3; ++n)
    for (std::size_t i = 0; i < nodes[n].count; ++i) {
      best[n][i] = -1e9;
      for (std::size_t j = 0; j < nodes[n - 1].count; ++j) {
        double score = best[n - 1][j] + length_score(scene, bones.bones[n], nodes[n - 1].all[j].p, nodes[n].all[i].p);
        if (same_surface(nodes[n].all[i], nodes[n - 1].all[j]) && n < 2) score += kSameSurface;
        if (score > best[n][i]) {
          best[n][i] = score;
          from[n][i] = j;
        }
      }
      best[n][i] += nodes[n].all[i].score;
    }
  LimbChoice out;
  for (std::size_t i = 0; i < nodes[2].count; ++i) {
    if (best[2][i] <= out.score) continue;
    out.score = best[2][i];
    const std::size_t j = from[2][i];
    out.joints = {nodes[0].all[from[1][j]], nodes[1].all[j], nodes[2].all[i]};
  }
  return out;
}

bool share_a_surface(const Scene& scene, const LimbChoice& a, const Taken& b) {
  return std::ranges::any_of(a.joints, [&](const Candidate& one) { return b.has(scene, one); });
}

void choose_limbs(const Scene& scene, const std::array<Limb, 2>& limbs, const LimbBones& bones, Choices& out) {
  const auto alone = [&](std::size_t s, const Taken& taken) {
    return choose_limb(scene, limbs[s], bones, out[limbs[s][0]].p, taken);
  };
  std::array<LimbChoice, 2> chosen = {alone(0, {}), alone(1, {})};
  const std::array<Taken, 2> taken = {Taken{out[limbs[0][0]], chosen[0].joints}, Taken{out[limbs[1][0]], chosen[1].joints}};
  if (share_a_surface(scene, chosen[0], taken[1]) || share_a_surface(scene, chosen[1], taken[0])) {
    const LimbChoice right = alone(1, taken[0]), left = alone(0, taken[1]);
    if (chosen[0].score + right.score >= left.score + chosen[1].score)
      chosen[1] = right;
    else
      chosen[0] = left;
  }
  for (std::size_t s = 0; s < 2; ++s)
    for (std::size_t n = 0; n < 3; ++n) out[limbs[s][n + 1]] = choice_of(scene, chosen[s].joints[n]);
}

void choose_head(const Scene& scene, Choices& out) {
  constexpr JointId id = JointId::kHead;
  Candidates candidates;
  add_surfaces(scene, id, kMostExpected, candidates);
  add_hidden(scene, id, on_ray(scene, id, scene.expected[id].p.z), kMostExpected, candidates);
  const Vec3 shoulders = middle(out[JointId::kLeftShoulder].p, out[JointId::kRightShoulder].p);
  double best = -1e9;
  for (const Candidate& c : candidates.get()) {
    const double score = c.score + length_score(scene, Bone::kNeckHead, shoulders, c.p);
    if (score <= best) continue;
    best = score;
    out[id] = choice_of(scene, c);
  }
}

}  // namespace

double depth_of_joint_m(JointId id, double width_m, double away) {
  using enum JointId;
  switch (id) {
    case kLeftShoulder:
    case kRightShoulder:
      return 0.185 * width_m + 0.045 * away;
    case kLeftHip:
    case kRightHip:
      return 0.37 * width_m + 0.03 * away;
    case kHead:
      return 0.109;
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
  const double line = is_hip(id) ? scene.across.hips.z : scene.across.shoulders.z;
  const double behind = depth_of_joint_m(id, scene.width_m(), is_left(id) ? line : -line);
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

void choose(Scene& scene, Choices& out) {
  using enum JointId;
  choose_line(scene, kLeftShoulder, kRightShoulder, Bone::kShoulders, scene.across.shoulders, out);
  choose_line(scene, kLeftHip, kRightHip, Bone::kHips, scene.across.hips, out);
  choose_head(scene, out);
  choose_limbs(scene, kArmChains, kArmBones, out);
  choose_limbs(scene, kLegChains, kLegBones, out);
}

}  // namespace duo::body
