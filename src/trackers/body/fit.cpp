#include "trackers/body/fit.h"

#include <algorithm>

#include "trackers/body/candidates.h"

namespace duo::body {
namespace {

constexpr int kSteps = 6;
constexpr double kCauchy = 2;
constexpr double kHiddenPoint = 4, kOutsidePoint = 2;  // a point's sigma grows by this
constexpr double kGoesIn_m = 0.12;                     // from there to a hidden wrist or hand, one standard deviation
constexpr double kLeap = 2;                            // times Cauchy's scale: where a joint on a surface was expected
constexpr double kBoneSigma_m = 0.012, kTrunkSigma_m = 0.02;

constexpr std::array<std::size_t, kJoints> free_index() {
  std::array<std::size_t, kJoints> out = {};
  for (std::size_t i = 0; i < kFreeJoints.size(); ++i) out[index_of(kFreeJoints[i])] = i;
  return out;
}
constexpr auto kFreeIndex = free_index();
constexpr std::size_t at(JointId id) { return kFreeIndex[index_of(id)]; }

double cauchy(double residual) { return 1 / (1 + square(residual / kCauchy)); }

struct FitBone {
  JointId a, b;
  Bone bone;
};
constexpr FitBone kFitBones[] = {
    {JointId::kLeftShoulder, JointId::kRightShoulder, Bone::kShoulders},
    {JointId::kLeftHip, JointId::kRightHip, Bone::kHips},
    {JointId::kLeftShoulder, JointId::kLeftElbow, Bone::kUpperArm},
    {JointId::kRightShoulder, JointId::kRightElbow, Bone::kUpperArm},
    {JointId::kLeftElbow, JointId::kLeftWrist, Bone::kForearm},
    {JointId::kRightElbow, JointId::kRightWrist, Bone::kForearm},
    {JointId::kLeftWrist, JointId::kLeftHand, Bone::kPalm},
    {JointId::kRightWrist, JointId::kRightHand, Bone::kPalm},
    {JointId::kLeftHip, JointId::kLeftKnee, Bone::kThigh},
    {JointId::kRightHip, JointId::kRightKnee, Bone::kThigh},
    {JointId::kLeftKnee, JointId::kLeftAnkle, Bone::kShin},
    {JointId::kRightKnee, JointId::kRightAnkle, Bone::kShin},
    {JointId::kLeftAnkle, JointId::kLeftFoot, Bone::kFoot},
    {JointId::kRightAnkle, JointId::kRightFoot, Bone::kFoot},
};

using Equations = PointEquations<kFreeJoints.size()>;

/// Adds the terms of one linearisation.
class Terms {
 public:
  Terms(const Scene& scene, const Choices& chosen, const Places& now, Equations& equations)
      : scene_(scene), chosen_(chosen), now_(now), equations_(equations) {}

  void add_all() {
    for (const JointId id : kFreeJoints) {
      add_point(id);
      add_depth(id);
      add_expected(id);
      if (chosen_[id].on_surface) continue;
      add_guess(id);
      add_back(id);
      add_hanging(id);
    }
    for (const FitBone& bone : kFitBones) add_bone(bone);
    add_trunk();
    add_lines();
    for (const Limb& arm : kArmChains) add_straight_hand(arm);
  }

  /// The bone between two joints where a limb was cut.
  void add_sample(const LimbSample& sample) {
    const Vec3 pa = now_[sample.a], pb = now_[sample.b];
    const double s = 1 / sample.z_sigma_m, rest = 1 - sample.share;
    const double r = s * (rest * pa.z + sample.share * pb.z - sample.z_m);
    add(r, {{at(sample.a), {0, 0, rest * s}}, {at(sample.b), {0, 0, sample.share * s}}}, cauchy(r));
    if (!sample.has_edges) return;
    const Rectified& g = *scene_.depth.geometry;
    const Vec3 p = rest * pa + sample.share * pb;
    const double z = std::max(p.z, 0.2), f = g.focal_px / (z * sample.sigma_px);
    const Vec2 n = sample.normal;
    const double off = ((g.focal_px * p.x / z + g.cx_px - sample.middle_px.x) * n.x +
                        (g.focal_px * p.y / z + g.cy_px - sample.middle_px.y) * n.y) /
                       sample.sigma_px;
    const Vec3 slope = {f * n.x, f * n.y, -f * (p.x * n.x + p.y * n.y) / z};
    add(off, {{at(sample.a), rest * slope}, {at(sample.b), sample.share * slope}}, cauchy(off));
  }

 private:
  void add_point(JointId id) {
    const Point& point = scene_.points[id];
    const Vec3 p = now_[id];
    const Rectified& g = *scene_.depth.geometry;
    double sigma = point.sigma_px;
    if (!chosen_[id].on_surface) sigma *= kHiddenPoint;
    if (!point.inside) sigma *= kOutsidePoint;
    const double z = std::max(p.z, 0.2);
    // Of an arm behind the back the mark shows where it goes in.
    if (!chosen_[id].on_surface && scene_.off_back_m(id, p)) sigma = std::max(sigma, kGoesIn_m * g.focal_px / z);
    const double f = g.focal_px / (z * sigma);
    const double rx = (g.focal_px * p.x / z + g.cx_px - point.at_px.x) / sigma;
    const double ry = (g.focal_px * p.y / z + g.cy_px - point.at_px.y) / sigma;
    const double weight = 1 / (1 + (square(rx) + square(ry)) / square(kCauchy));
    add(rx, {{at(id), {f, 0, -f * p.x / z}}}, weight);
    add(ry, {{at(id), {0, f, -f * p.y / z}}}, weight);
  }

  void add_depth(JointId id) {
    const Choice& choice = chosen_[id];
    if (!choice.on_surface) return;
    const double s = 1 / choice.z_sigma_m, r = s * (now_[id].z - choice.p.z);
    add(r, {{at(id), {0, 0, s}}}, cauchy(r));
  }

  void add_expected(JointId id) {
    const Expected& expected = scene_.expected[id];
    const double s = 1 / expected.sigma_m;
    const Vec3 off = now_[id] - expected.p;
    const double weight = chosen_[id].on_surface ? cauchy(s * norm(off) / kLeap) : 1;
    add(s * off.x, {{at(id), {s, 0, 0}}}, weight);
    add(s * off.y, {{at(id), {0, s, 0}}}, weight);
    add(s * off.z, {{at(id), {0, 0, s}}}, weight);
  }

  /// A hidden joint near where it was guessed.
  void add_guess(JointId id) {
    const double s = 1 / 0.07;
    const Vec3 off = now_[id] - chosen_[id].p;
    add(s * off.x, {{at(id), {s, 0, 0}}});
    add(s * off.y, {{at(id), {0, s, 0}}});
    add(s * off.z, {{at(id), {0, 0, s}}});
  }

  /// A hand behind the back lies on it.
  void add_back(JointId id) {
    const auto off = scene_.off_back_m(id, now_[id]);
    if (off) add(*off / kBackSigma_m, {{at(id), (-1 / kBackSigma_m) * scene_.trunk.front}});
  }

  /// An arm behind the trunk hangs beside it, and does not pull at its shoulder.
  void add_hanging(JointId id) {
    const JointId shoulder = is_left(id) ? JointId::kLeftShoulder : JointId::kRightShoulder;
    const auto off = scene_.off_hanging_m(id, now_[id], now_[shoulder]);
    if (!off) return;
    const double s = (is_left(id) ? 1 : -1) / (is_hand_or_wrist(id) ? kHangingSigma_m : kHangingElbowSigma_m);
    add(std::abs(s) * *off, {{at(id), s * scene_.trunk.across}});
  }

  void add_length(JointId a, JointId b, double length, double sigma, double weight = 1) {
    const Vec3 way = now_[b] - now_[a];
    const double now = std::max(norm(way), 1e-4), s = 1 / sigma;
    const Vec3 along = (s / now) * way;
    add(s * (now - length), {{at(b), along}, {at(a), -1.0 * along}}, weight);
  }

  void add_bone(const FitBone& bone) {
    add_length(bone.a, bone.b, (*scene_.lengths)[bone.bone], std::max(kBoneSigma_m, scene_.lengths->sigma_m(bone.bone)));
  }

  void add_trunk() {
    using enum JointId;
    const double trunk = (*scene_.lengths)[Bone::kTrunk],
                 sigma = std::max(kTrunkSigma_m, scene_.lengths->sigma_m(Bone::kTrunk));
    const double half = ((*scene_.lengths)[Bone::kShoulders] - (*scene_.lengths)[Bone::kHips]) / 2;
    const double side = std::sqrt(square(trunk) + square(half));
    for (const auto& [a, b] : {std::pair{kLeftShoulder, kLeftHip}, std::pair{kRightShoulder, kRightHip}}) {
      const double r = (distance(now_[a], now_[b]) - side) / sigma;
      add_length(a, b, side, sigma, cauchy(r));
    }
    // The head above the shoulders' middle.
    const Vec3 way = now_[kHead] - middle(now_[kLeftShoulder], now_[kRightShoulder]);
    const double now = std::max(norm(way), 1e-4), s = 1 / std::max(0.02, scene_.lengths->sigma_m(Bone::kNeckHead));
    const Vec3 along = (s / now) * way, half_back = -0.5 * along;
    const double r = s * (now - (*scene_.lengths)[Bone::kNeckHead]);
    add(r, {{at(kHead), along}, {at(kLeftShoulder), half_back}, {at(kRightShoulder), half_back}}, cauchy(r));
  }

  /// The network's turn of the trunk: doubtful head on, where depth is better, and good from the side.
  void add_lines() {
    using enum JointId;
    const auto line = [&](JointId left, JointId right, Bone bone, Vec3 across) {
      const double width = (*scene_.lengths)[bone];
      const double turned = std::min(std::abs(across.z), 1.0);
      const double s = 1 / (width * (0.45 - 0.27 * turned));
      const double r = s * (now_[left].z - now_[right].z - width * across.z);
      add(r, {{at(left), {0, 0, s}}, {at(right), {0, 0, -s}}}, cauchy(r));
    };
    line(kLeftShoulder, kRightShoulder, Bone::kShoulders, scene_.across.shoulders);
    line(kLeftHip, kRightHip, Bone::kHips, scene_.across.hips);
  }

  /// The hand goes on where the forearm points.
  void add_straight_hand(const Limb& arm) {
    const double s = 1 / (chosen_[arm[3]].on_surface ? 0.06 : 0.025);
    const double share = (*scene_.lengths)[Bone::kPalm] / (*scene_.lengths)[Bone::kForearm];
    const Vec3 off = now_[arm[3]] - now_[arm[2]] - share * (now_[arm[2]] - now_[arm[1]]);
    const auto axis = [&](double r, Vec3 unit) {
      add(s * r, {{at(arm[3]), s * unit}, {at(arm[2]), (-s * (1 + share)) * unit}, {at(arm[1]), (s * share) * unit}});
    };
    axis(off.x, {1, 0, 0});
    axis(off.y, {0, 1, 0});
    axis(off.z, {0, 0, 1});
  }

  void add(double residual, std::initializer_list<Slope> slopes, double weight = 1) {
    equations_.add(residual, std::span<const Slope>(slopes.begin(), slopes.size()), weight);
  }

  const Scene& scene_;
  const Choices& chosen_;
  const Places& now_;
  Equations& equations_;
};

}  // namespace

Places with_lengths(const Places& places, const Lengths& lengths) {
  using enum JointId;
  Places out = places;
  const Vec3 chest = middle(places[kLeftShoulder], places[kRightShoulder]),
             pelvis = middle(places[kLeftHip], places[kRightHip]);
  const Vec3 up = chest - pelvis, longer = (0.5 * (lengths.kept(Bone::kTrunk) / std::max(norm(up), 1e-6) - 1)) * up;
  const auto widen = [&](JointId left, JointId right, Bone bone, Vec3 centre) {
    const Vec3 across = places[left] - places[right];
    const Vec3 half = (0.5 * lengths.kept(bone) / std::max(norm(across), 1e-6)) * across;
    out[left] = centre + half;
    out[right] = centre - half;
  };
  widen(kLeftShoulder, kRightShoulder, Bone::kShoulders, chest + longer);
  widen(kLeftHip, kRightHip, Bone::kHips, pelvis - longer);
  const auto follow = [&](const Limb& limb, const std::array<Bone, 3>& bones) {
    for (std::size_t n = 0; n < bones.size(); ++n) {
      const Vec3 way = places[limb[n + 1]] - places[limb[n]];
      out[limb[n + 1]] = out[limb[n]] + (lengths.kept(bones[n]) / std::max(norm(way), 1e-6)) * way;
    }
  };
  for (const Limb& arm : kArmChains) follow(arm, {Bone::kUpperArm, Bone::kForearm, Bone::kPalm});
  for (const Limb& leg : kLegChains) follow(leg, {Bone::kThigh, Bone::kShin, Bone::kFoot});
  complete(out);
  const Vec3 head = out[kHead] - out[kNeck];
  out[kHead] = out[kNeck] + (lengths.kept(Bone::kHead) / std::max(norm(head), 1e-6)) * head;
  return out;
}

// As a skeleton at rest has it: pelvis and chest are where hips and shoulders begin; the spine leaves the pelvis at a right
// angle to the hips, and the neck the chest to the shoulders.
void complete(Places& places) {
  using enum JointId;
  constexpr double kNeckBehind_m = 0.022;
  const auto across = [&](JointId left, JointId right, Vec3 way) {
    const Vec3 line = places[left] - places[right];
    return way - (dot(way, line) / std::max(dot(line, line), 1e-9)) * line;
  };
  places[kPelvis] = middle(places[kLeftHip], places[kRightHip]);
  places[kChest] = middle(places[kLeftShoulder], places[kRightShoulder]);
  const Vec3 up = places[kChest] - places[kPelvis], back = cross(up, places[kLeftShoulder] - places[kRightShoulder]);
  const Vec3 upright = across(kLeftHip, kRightHip, up);
  places[kSpine] = places[kPelvis] + (0.5 * norm(up) / std::max(norm(upright), 1e-6)) * upright;
  const Vec3 above = across(kLeftShoulder, kRightShoulder, up);
  places[kNeck] = places[kChest] + (kNeckAbove * norm(up) / std::max(norm(above), 1e-6)) * above +
                  (kNeckBehind_m / std::max(norm(back), 1e-6)) * back;
}

void Fit::run(const Scene& scene, const Choices& chosen, const LimbSamples& samples, Fitted& out) {
  for (const JointId id : kFreeJoints) out.places[id] = chosen[id].p;
  for (int step = 0; step < kSteps; ++step) {
    equations_.clear();
    Terms terms(scene, chosen, out.places, equations_);
    terms.add_all();
    for (const LimbSample& sample : samples.get()) terms.add_sample(sample);
    if (!equations_.factor()) break;
    const auto move = equations_.step();
    for (std::size_t i = 0; i < kFreeJoints.size(); ++i) {
      const double length = norm(move[i]), most = 0.5;
      Vec3& p = out.places[kFreeJoints[i]];
      p = p + (length > most ? most / length : 1.0) * move[i];
      p.z = std::max(p.z, 0.2);
    }
  }
  for (const JointId id : kFreeJoints) {
    const auto c = equations_.covariance(at(id));
    out.covariance[id] = {c[0], c[1], c[2], c[3], c[4], c[5]};
  }
  complete(out.places);
}

}  // namespace duo::body
