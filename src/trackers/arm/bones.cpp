#include "trackers/arm/bones.h"

#include <array>
#include <cmath>
#include <numbers>

namespace duo::arm {
namespace {

constexpr double kSkin = 0.7;  // radii before the bone: where stereo sees a round limb on average

/// How well a place inside the limb agrees with the cell it falls on.
double spot_evidence(const Grid& grid, const Silhouette& silhouette, Vec3 p, double radius_m, double disparity_sigma_px) {
  constexpr double kOutside = -0.5, kUnknown = -0.6, kShinesThrough = -2, kHidden = -0.7, kBody = -0.4, kWorst = -0.7;
  constexpr double kOtherSurfaceM = 0.12, kLimbSigmaM = 0.035;
  const int i = grid.cell_of(p);
  if (i < 0 || !grid.inside[static_cast<std::size_t>(i)]) return kOutside;
  if (!grid.known(i)) return kUnknown;
  if (!silhouette.front[static_cast<std::size_t>(i)]) return kShinesThrough;
  const double miss_m = grid.z(i) - (p.z - kSkin * radius_m);
  if (miss_m > kOtherSurfaceM) return kShinesThrough;
  if (miss_m < -kOtherSurfaceM) return kHidden;
  const double z_sigma_m = grid.z_sigma_m(p.z, disparity_sigma_px);
  const double evidence = std::max(kWorst, 1 - 0.5 * miss_m * miss_m / (kLimbSigmaM * kLimbSigmaM + z_sigma_m * z_sigma_m));
  return silhouette.body[static_cast<std::size_t>(i)] ? std::min(evidence, kBody) : evidence;
}

/// How well a place inside a limb whose end is not seen agrees with the cell it falls on: it may be covered or outside, but
/// nothing behind it may shine through.
double way_out_evidence(const Grid& grid, const Silhouette& silhouette, Vec3 p, double radius_m) {
  constexpr double kShinesThrough = -2, kSeen = 0.5, kSurfaceM = 0.06, kOtherSurfaceM = 0.12;
  const int i = grid.cell_of(p);
  if (i < 0 || !grid.inside[static_cast<std::size_t>(i)] || !grid.known(i)) return 0;
  if (!silhouette.front[static_cast<std::size_t>(i)]) return kShinesThrough;
  const double miss_m = grid.z(i) - (p.z - kSkin * radius_m);
  if (miss_m > kOtherSurfaceM) return kShinesThrough;
  return std::abs(miss_m) < kSurfaceM && !silhouette.body[static_cast<std::size_t>(i)] ? kSeen : 0;
}

struct Hypothesis {
  Vec3 p;
  double score;
};

/// Hypotheses weighed by their likelihood, whose logarithm their scores are; no heap.
class Hypotheses {
 public:
  void add(Vec3 p, double score) {
    if (count_ == items_.size()) return;
    items_[count_++] = {p, score};
    best_ = std::max(best_, score);
  }
  double best() const { return best_; }
  ElbowSeen sum_up() const {
    Vec3 mean;
    double weights = 0, variance = 0;
    const auto weight = [&](const Hypothesis& h) { return std::exp(h.score - best_); };
    for (std::size_t i = 0; i < count_; ++i) {
      mean = mean + weight(items_[i]) * items_[i].p;
      weights += weight(items_[i]);
    }
    mean = (1 / weights) * mean;
    for (std::size_t i = 0; i < count_; ++i) variance += weight(items_[i]) * dot(items_[i].p - mean, items_[i].p - mean);
    return {mean, best_, std::sqrt(variance / weights)};
  }

 private:
  std::array<Hypothesis, 480> items_;
  std::size_t count_ = 0;
  double best_ = -1e9;
};

double prior_of(const JointPrior& prior, Vec3 p) {
  const Vec3 q = p - prior.p;
  return -0.5 * dot(q, q) / (prior.sigma_m * prior.sigma_m);
}

/// Log likelihood of an elbow `aside_m` off the way from shoulder to hand: it sags, and where the hand hangs it points
/// backwards. Stereo cannot tell on which side of an almost straight arm its elbow is.
double ease_of(Vec3 way, Vec3 aside_m, Vec3 back) {
  constexpr double kMost = 1.5, kScaleM = 0.03;
  const Vec3 n = normalized(way);
  const Vec3 easy = Vec3{0, 1, 0} + std::max(0.0, n.y) * back;
  return kMost * std::tanh(dot(aside_m, easy - dot(easy, n) * n) / kScaleM);
}

/// Two directions across a unit vector.
void across(Vec3 n, Vec3& e1, Vec3& e2) {
  e1 = normalized(cross(n, std::abs(n.y) < 0.9 ? Vec3{0, 1, 0} : Vec3{1, 0, 0}));
  e2 = cross(n, e1);
}

/// Calls f(direction) for unit vectors in rings around n.
template <class F>
void each_direction(Vec3 n, Cap cap, F&& f) {
  Vec3 e1, e2;
  across(n, e1, e2);
  for (int ring = 0; ring <= cap.rings; ++ring) {
    const int steps = std::max(1, 6 * ring);
    for (int k = 0; k < steps; ++k) {
      const double tilt = ring * cap.ring_rad, turn = 2 * std::numbers::pi * k / steps;
      f(std::cos(tilt) * n + std::sin(tilt) * (std::cos(turn) * e1 + std::sin(turn) * e2));
    }
  }
}

constexpr Cap kAllDirections{0.2, 12};  // but those close to the opposite one

}  // namespace

double bone_evidence(const Grid& grid, const Silhouette& silhouette, const Bone& bone, double disparity_sigma_px) {
  constexpr double kBeside = 2.1;  // radii from the bone: there a limb has ended
  constexpr double kWidePenalty = 0.3, kSameSurfaceM = 0.05;
  const Vec2 a = grid.camera.project(bone.a), b = grid.camera.project(bone.b);
  const double dx = b.x - a.x, dy = b.y - a.y, length = std::hypot(dx, dy);
  double sum = 0;
  for (int n = 0; n < bone.samples; ++n) {
    const Vec3 p = bone.a + (bone.from + (bone.to - bone.from) * n / (bone.samples - 1.0)) * (bone.b - bone.a);
    sum += spot_evidence(grid, silhouette, p, bone.radius_m, disparity_sigma_px);
    if (length < 1) continue;
    const Vec2 at = grid.camera.project(p);
    const double aside = kBeside * bone.radius_m * grid.camera.focal_px / (p.z * length);
    for (const int side : {-1, 1}) {
      const int x = static_cast<int>(std::lround(at.x - side * dy * aside)),
                y = static_cast<int>(std::lround(at.y + side * dx * aside));
      if (!grid.contains(x, y) || !silhouette.front[static_cast<std::size_t>(grid.at(x, y))]) continue;
      if (std::abs(grid.z(grid.at(x, y)) - (p.z - kSkin * bone.radius_m)) < kSameSurfaceM) sum -= kWidePenalty;
    }
  }
  return sum / bone.samples;
}

ElbowCircle::ElbowCircle(Vec3 shoulder, Vec3 hand, const Lengths& l) {
  constexpr double kSlackM = 0.001;
  const double distance = norm(hand - shoulder);
  const double d = std::clamp(distance, std::abs(l.upper_m - l.fore_m) + kSlackM, l.upper_m + l.fore_m - kSlackM);
  const double along = (l.upper_m * l.upper_m - l.fore_m * l.fore_m + d * d) / (2 * d);
  const Vec3 n = normalized(hand - shoulder);
  radius_m = std::sqrt(std::max(0.0, l.upper_m * l.upper_m - along * along));
  centre = shoulder + (along * distance / d) * n;
  stretch_m = std::abs(distance - d);
  across(n, e1, e2);
}

Vec3 ElbowCircle::at(double angle_rad) const {
  return centre + radius_m * (std::cos(angle_rad) * e1 + std::sin(angle_rad) * e2);
}

double ElbowFinder::upper(Vec3 shoulder, Vec3 elbow, int samples) const {
  return bone_evidence(grid_, silhouette_, {shoulder, elbow, params_.upper_radius_m, 0.35, 1, samples},
                       params_.disparity_sigma_px);
}
double ElbowFinder::fore(Vec3 elbow, Vec3 hand) const {
  return bone_evidence(grid_, silhouette_, {elbow, hand, params_.fore_radius_m, 0.12, 0.75, 5}, params_.disparity_sigma_px);
}

ElbowSeen ElbowFinder::between(Vec3 shoulder, Vec3 hand, const JointPrior& prior, Vec3 back) const {
  constexpr double kEvidence = 3;  // weight of a bone: its samples are not independent
  constexpr double kOtherLength = 0.15, kStretchPerM = 20;
  constexpr double kStepM = 0.02;  // along the circle
  constexpr double kHopeless = 6;  // below the best so far: has no weight
  Hypotheses hypotheses;
  for (const double scale : {1.0, 0.94, 1.06}) {  // lengths come from three clicks
    const ElbowCircle circle(shoulder, hand, {lengths_.upper_m * scale, lengths_.fore_m * scale});
    const int steps = std::clamp(static_cast<int>(2 * std::numbers::pi * circle.radius_m / kStepM), 1, 48);
    for (int k = 0; k < steps; ++k) {
      const Vec3 elbow = circle.at(2 * std::numbers::pi * k / steps);
      const double before = prior_of(prior, elbow) + ease_of(hand - shoulder, elbow - circle.centre, back) -
                            (scale != 1 ? kOtherLength : 0) - kStretchPerM * circle.stretch_m;
      if (before + 2 * kEvidence < hypotheses.best() - kHopeless) continue;
      hypotheses.add(elbow, before + kEvidence * (upper(shoulder, elbow, 5) + fore(elbow, hand)));
    }
  }
  return hypotheses.sum_up();
}

ElbowSeen ElbowFinder::near(Vec3 shoulder, const JointPrior& prior) const { return in_directions(shoulder, prior, {0.13, 6}); }

ElbowSeen ElbowFinder::anywhere(Vec3 shoulder, const JointPrior& prior) const {
  return in_directions(shoulder, prior, kAllDirections);
}

ElbowSeen ElbowFinder::in_directions(Vec3 shoulder, const JointPrior& prior, Cap cap) const {
  constexpr double kEvidence = 4;
  Hypotheses hypotheses;
  each_direction(normalized(prior.p - shoulder), cap, [&](Vec3 direction) {
    const Vec3 elbow = shoulder + lengths_.upper_m * direction;
    hypotheses.add(elbow, prior_of(prior, elbow) + kEvidence * upper(shoulder, elbow, 6));
  });
  return hypotheses.sum_up();
}

std::optional<Vec3> ElbowFinder::hand_outside(Vec3 elbow, const JointPrior& prior) const {
  constexpr double kEvidence = 4, kFrom = 0.15;  // nearer to the elbow all directions look alike
  constexpr int kSamples = 7;
  Hypotheses hypotheses;
  each_direction(normalized(prior.p - elbow), kAllDirections, [&](Vec3 direction) {
    double sum = 0;
    for (int i = 0; i < kSamples; ++i) {
      const double share = kFrom + (1 - kFrom) * i / (kSamples - 1);
      sum += way_out_evidence(grid_, silhouette_, elbow + share * lengths_.fore_m * direction, params_.fore_radius_m);
    }
    const Vec3 hand = elbow + lengths_.fore_m * direction;
    hypotheses.add(hand, prior_of(prior, hand) + kEvidence * sum / kSamples);
  });
  const Vec3 hand = hypotheses.sum_up().p;
  if (grid_.cell_of(hand) >= 0) return {};
  return hand;
}

}  // namespace duo::arm
