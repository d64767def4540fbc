// Hypotheses for hand and elbow together, and which one to believe.
#include <algorithm>
#include <cmath>

#include "trackers/arm/arm.h"

namespace duo::arm {
namespace {

constexpr int kLongUnseen = 3;  // frames: from then on only a good candidate may take over

}  // namespace

/// What stands in front, is not the body's surface and hangs together with the predicted elbow: sleeves have no skin colour.
std::span<const Region> Arm::find_limb(const Grid& grid, const Prediction& predicted) {
  constexpr double kBeyondM = 0.22, kSlackM = 0.20;
  constexpr int kMajority = 6;
  for (int i = 0; i < grid.size(); ++i) {
    const auto k = static_cast<std::size_t>(i);
    mask_[k] = 0;
    if (!silhouette_.front[k] || silhouette_.body[k]) continue;
    const Vec3 p = grid.point(i);
    mask_[k] = norm(p - predicted.elbow) < lengths_.fore_m + kBeyondM && norm(p - shoulder_.p) < lengths_.reach_m() + kSlackM;
  }
  keep_majority(grid, mask_, scratch_, kMajority);
  return limb_regions_.find(grid, mask_, params_.region_step_m);
}

std::optional<Arm::Candidate> Arm::best_candidate(const Scene& scene, const Prediction& predicted) {
  constexpr double kLeastLimbM2 = 0.006, kElbowM = 0.10;
  const Grid& grid = scene.grid;
  std::optional<Candidate> best;
  const auto try_region = [&](const Region& region, bool by_skin) {
    if (region.area_m2 < params_.least_hand_m2) return;
    for (const bool gated : {true, false}) {
      const auto c = candidate(grid, region, predicted, gated, by_skin);
      if (c && (!best || c->score > best->score)) best = c;
    }
  };
  for (const Region& region : skin_regions_.find(grid, silhouette_.skin, params_.region_step_m)) try_region(region, true);
  for (const Region& region : find_limb(grid, predicted)) {
    const auto at_elbow = [&](int i) { return norm(grid.point(i) - predicted.elbow) < kElbowM; };
    if (region.area_m2 >= kLeastLimbM2 && std::any_of(region.cells.begin(), region.cells.end(), at_elbow))
      try_region(region, false);
  }
  return best;
}

/// The hand at the far end of a region, seen from the elbow that goes with it. Scores are log likelihoods: bones, distance from
/// the prediction, size, kind of region, length of the forearm, and whether it ends there or goes on behind something.
std::optional<Arm::Candidate> Arm::candidate(const Grid& grid, const Region& region, const Prediction& predicted, bool gated,
                                             bool by_skin) {
  constexpr double kMostReach = 1.15;                              // of the bones' lengths
  constexpr double kJumpM = 0.22, kJumpGrowthMPerS = 4.5;          // from the prediction
  constexpr double kLimbLeastSkin = 0.15, kLimbLeastLength = 0.6;  // a limb must end in some skin, far enough from the elbow
  constexpr double kSolidM2 = 0.0006, kLimbSolidM2 = 0.0003, kLeastSolidM2 = 0.0002;
  constexpr double kUnseenElbowScore = 0.5, kMostForgiven = 2, kForgivingM2 = 0.0035;
  const double unseen_s = seconds(hand_.unseen);
  const Gate gate{predicted.hand, params_.hand_gate_m + params_.hand_gate_growth_m_s * unseen_s};
  const double elbow_sigma_m = params_.elbow_prior_m + params_.elbow_prior_growth_m_s * seconds(elbow_.unseen) +
                               0.25 * norm(hand_.step) + (hand_.seen() ? 0 : params_.elbow_prior_hidden_hand_m);
  const Vec3 back = torso_.rig_from_torso().rotation * Vec3{0, 0, 1};
  const ElbowFinder elbows(grid, silhouette_, lengths_, params_);

  Candidate out;
  Vec3 elbow = predicted.elbow;
  for (int pass = 0; pass < 2; ++pass) {  // the hand depends on the elbow, and the elbow on the hand
    const auto hand =
        hands_.find(grid, silhouette_, region.cells, elbow, lengths_.fore_m, hand_centre_m_, gated ? &gate : nullptr, params_);
    if (!hand || hand->area_m2 < params_.least_hand_m2) return {};
    out.hand = *hand;
    out.elbow = elbows.between(shoulder_.p, out.hand.p, {predicted.elbow, elbow_sigma_m}, back);
    elbow = out.elbow.p;
  }

  const double jump_m = norm(out.hand.p - predicted.hand), fore_m = norm(out.hand.p - elbow);
  const double skin = out.hand.skin_m2 / std::max(1e-6, out.hand.area_m2);
  if (norm(out.hand.p - shoulder_.p) > kMostReach * lengths_.reach_m() || jump_m > kJumpM + kJumpGrowthMPerS * unseen_s)
    return {};
  if (!by_skin && (skin < kLimbLeastSkin || fore_m < kLimbLeastLength * lengths_.fore_m)) return {};
  if (out.hand.solid_m2 < (by_skin ? kSolidM2 : kLimbSolidM2) && (!hand_.seen() || out.hand.solid_m2 < kLeastSolidM2))
    return {};
  const double forgiven = std::min(kMostForgiven, out.hand.solid_m2 / kForgivingM2);  // much skin needs less of bones
  if (hand_.unseen > kLongUnseen && out.elbow.score < kUnseenElbowScore - forgiven) return {};

  constexpr double kMostJump = 6, kHandM2 = 0.008, kSize = 1.5, kUngated = 0.5, kLimb = 0.7, kMostlySkin = 0.6,
                   kForePerM = 0.5 / 0.03, kCovered = 4;
  const double prior_m = params_.hand_prior_m + params_.hand_prior_growth_m_s * unseen_s;
  out.score = out.elbow.score - std::min(kMostJump, 0.5 * std::pow(jump_m / prior_m, 2)) +
              kSize * std::min(1.0, out.hand.area_m2 / kHandM2) - (gated ? 0 : kUngated) -
              (by_skin ? 0 : kLimb + 2 * std::max(0.0, kMostlySkin - skin)) - kForePerM * std::abs(fore_m - lengths_.fore_m) -
              kCovered * covered_beyond(grid, silhouette_.front, elbow, out.hand, params_);
  return out;
}

/// The longer a hand was hidden, the better must be what claims to be it; much solid skin counts for it.
double Arm::least_score(const Candidate& best) const {
  constexpr double kFollowed = -2.5, kUnseen = -1.5, kLong = 0.5, kMostForgiven = 1.5, kForgivingM2 = 0.004;
  if (hand_.seen()) return kFollowed;
  if (hand_.unseen <= kLongUnseen) return kUnseen;
  return kLong - std::min(kMostForgiven, best.hand.solid_m2 / kForgivingM2);
}

}  // namespace duo::arm
