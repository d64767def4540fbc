#include "trackers/body/choose.h"

#include <algorithm>

#include "trackers/body/behind_back.h"
#include "trackers/body/candidates.h"

namespace duo::body {
namespace {

Choice choice_of(const Scene& scene, const Candidate& c) {
  const bool on = !c.hidden() && !c.doubtful;
  return {c.p, on, on ? z_sigma_m(scene, c.p.z) : 0};
}

/// How well a place of a hip goes with the surfaces that the knee may be on, a thigh's length away. Of who sits, the thighs
/// hide the hips.
double knee_score(const Scene& scene, const Candidates& knees, Vec3 hip) {
  constexpr double kHiddenKnee = -6;
  double best = kHiddenKnee;
  for (const Candidate& knee : knees.get()) best = std::max(best, knee.score + length_score(scene, Bone::kThigh, hip, knee.p));
  return best;
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
  if (bone == Bone::kHips)
    for (std::size_t s = 0; s < 2; ++s) {
      const JointId knee = kLegChains[s][1];
      Candidates knees;
      add_surfaces(scene, knee, kMostExpected, knees);
      for (const Candidate& k : knees.get())
        add_sphere(scene, ids[s], k.p, (*scene.lengths)[Bone::kThigh], kMostExpectedRoot, sides[s]);
      for (std::size_t i = 0; i < sides[s].count; ++i) sides[s].all[i].score += knee_score(scene, knees, sides[s].all[i].p);
    }
  // Head on, depth tells how the line is turned; from the side the network does.
  const double turned = std::min(std::abs(across.z), 1.0);
  const double line_sigma = width * (0.35 - 0.17 * turned) + 0.3 * scene.depth.m_per_px(scene.trunk_z_m) * kDepthSigma_px;
  // Chosen before the hips.
  const Vec3 shoulders = middle(out[JointId::kLeftShoulder].p, out[JointId::kRightShoulder].p) + scene.lift_m();
  double best = -1e9;
  for (const Candidate& a : sides[0].get())
    for (const Candidate& b : sides[1].get()) {
      double score =
          a.score + b.score + length_score(scene, bone, a.p, b.p) + capped(a.p.z - b.p.z - width * across.z, line_sigma, 8);
      // What stands before the hips alone is no trunk. It tells of both of them.
      if (bone == Bone::kHips) score += 2 * length_score(scene, Bone::kTrunk, shoulders, middle(a.p, b.p));
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

LimbChoice choose_limb(const Scene& scene, const Limb& limb, const LimbBones& bones, Vec3 root, const Taken& taken) {
  std::array<Candidates, 3> nodes;
  for (std::size_t n = 0; n < 3; ++n) {
    const JointId id = limb[n + 1];
    const double most = n == 2 ? bones.most_end : bones.most_middle;
    add_surfaces(scene, id, most, nodes[n]);
    for (std::size_t i = 0; i < nodes[n].count; ++i)
      if (taken.has(scene, nodes[n].all[i])) nodes[n].all[i].score += kSameSurface;
    add_hidden(scene, id, on_ray(scene, id, scene.expected[id].p.z), most, nodes[n]);
    // The network guesses well how hidden legs walk, and badly where an arm behind the back is.
    if (is_arm(id)) add_hidden(scene, id, scene.expected[id].p, most, nodes[n]);
    if (n == 0) {
      add_sphere(scene, id, root, (*scene.lengths)[bones.bones[0]], most, nodes[0]);
    } else {
      const std::size_t parents = std::min<std::size_t>(nodes[n - 1].count, 7);
      for (std::size_t i = 0; i < parents; ++i)
        add_sphere(scene, id, nodes[n - 1].all[i].p, (*scene.lengths)[bones.bones[n]], most, nodes[n]);
    }
    if (n == 0 || !is_arm(id)) continue;
    const double from_elbow = (*scene.lengths)[bones.bones[1]] + (n == 2 ? (*scene.lengths)[bones.bones[2]] : 0);
    for (const Candidate& elbow : nodes[0].get())
      if (!elbow.hidden())
        if (const auto p = on_back(scene, limb[2], elbow.p, from_elbow)) add_hidden(scene, id, *p, most, nodes[n]);
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

void choose_limbs(const Scene& scene, const std::array<Limb, 2>& limbs, const LimbBones& bones, Choices& out) {
  const auto alone = [&](std::size_t s, const Taken& taken) {
    return choose_limb(scene, limbs[s], bones, out[limbs[s][0]].p, taken);
  };
  const auto taken_by = [&](std::size_t s, const LimbChoice& limb) { return Taken{out[limbs[s][0]], limb.joints}; };
  const auto share = [&](const LimbChoice& left, const LimbChoice& right) {
    const auto on = [&](const LimbChoice& limb, const Taken& taken) {
      return std::ranges::any_of(limb.joints, [&](const Candidate& c) { return taken.has(scene, c); });
    };
    return on(left, taken_by(1, right)) || on(right, taken_by(0, left));
  };
  std::array<LimbChoice, 2> chosen = {alone(0, {}), alone(1, {})};
  if (share(chosen[0], chosen[1])) {
    const LimbChoice right = alone(1, taken_by(0, chosen[0])), left = alone(0, taken_by(1, chosen[1]));
    const auto score = [&](const LimbChoice& l, const LimbChoice& r) {
      return l.score + r.score + (share(l, r) ? kSameSurface : 0);
    };
    if (score(chosen[0], right) >= score(left, chosen[1]))
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
  const Vec3 shoulders = middle(out[JointId::kLeftShoulder].p, out[JointId::kRightShoulder].p) + scene.lift_m();
  double best = -1e9;
  for (const Candidate& c : candidates.get()) {
    const double score = c.score + length_score(scene, Bone::kNeckHead, shoulders, c.p);
    if (score <= best) continue;
    best = score;
    out[id] = choice_of(scene, c);
  }
}

}  // namespace

void choose(Scene& scene, Choices& out) {
  using enum JointId;
  choose_line(scene, kLeftShoulder, kRightShoulder, Bone::kShoulders, scene.across.shoulders, out);
  choose_line(scene, kLeftHip, kRightHip, Bone::kHips, scene.across.hips, out);
  choose_head(scene, out);
  choose_limbs(scene, kArmChains, kArmBones, out);
  choose_limbs(scene, kLegChains, kLegBones, out);
}

}  // namespace duo::body
