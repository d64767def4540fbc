// The first frame: from three clicks to everything the arm must know.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "duoptic/statistics.h"
#include "trackers/arm/arm.h"

namespace duo::arm {
namespace {

Error no_depth(const Skeleton& arm, Part part) {
  const JointDef& joint = arm.joints[index_of(part)];
  return {ErrorCode::kBadInput,
          fmt::format("select the arm: no depth near the {} click; click on a textured part of the {}, or choose another frame",
                      joint.name, part_of(joint.id))};
}

/// Depth of a small disc; an arm is narrow, so what is near counts more.
std::optional<Vec3> limb_at(const Grid& grid, Vec2 at, double depth_m) {
  constexpr double kRadius = 3, kNear = 0.6;  // cells; quantile
  const auto z = disc_depth_m(grid, at, kRadius, kNear);
  if (!z) return {};
  return behind(grid.camera.unproject(at, *z), depth_m);
}

Result<void> check_lengths(const Lengths& lengths) {
  constexpr double kShortestM = 0.08, kLongestM = 0.7;
  const auto wrong = [&](double m) { return !(m >= kShortestM && m <= kLongestM); };
  const char* pair = wrong(lengths.upper_m) ? "shoulder and elbow" : wrong(lengths.fore_m) ? "elbow and hand" : nullptr;
  if (!pair) return {};
  return Error{ErrorCode::kBadInput,
               fmt::format("select the arm: {} lie {:.2f} m apart, which no arm spans; one of the clicks missed the arm", pair,
                           wrong(lengths.upper_m) ? lengths.upper_m : lengths.fore_m)};
}

}  // namespace

// Median depth of a wide disc of one surface: the cloth of a shoulder may be plain.
std::optional<Vec3> shoulder_at(const Grid& grid, Vec2 at, double depth_m, std::vector<double>& scratch) {
  constexpr double kFirstRadius = 5, kRadiusM = 0.075, kSurfaceM = 0.2, kNear = 0.45;
  const auto first = disc_depth_m(grid, at, kFirstRadius);
  if (!first) return {};
  scratch.clear();
  const int r = static_cast<int>(kRadiusM * grid.camera.focal_px / *first);
  const int x = static_cast<int>(std::lround(at.x)), y = static_cast<int>(std::lround(at.y));
  each_around(grid, x, y, r, [&](int i) {
    const int dx = i % grid.width - x, dy = i / grid.width - y;
    if (dx * dx + dy * dy <= r * r && grid.known(i) && std::abs(grid.z(i) - *first) < kSurfaceM) scratch.push_back(grid.z(i));
  });
  if (scratch.size() < 5) return {};
  const double z_m = nth(scratch, static_cast<std::size_t>(kNear * static_cast<double>(scratch.size())));
  return behind(grid.camera.unproject(at, z_m), depth_m);
}

Result<void> Arm::start(const Scene& scene, const Skeleton& arm, std::span<const Vec2, kParts> clicks_px) {
  const Grid& grid = scene.grid;
  depths_m_.reserve(static_cast<std::size_t>(grid.size()));
  const auto at = [&](Part part) { return in_blocks(clicks_px[index_of(part)], grid.step); };
  const auto hand = limb_at(grid, at(Part::kHand), params_.hand_depth_m),
             elbow = limb_at(grid, at(Part::kElbow), params_.elbow_depth_m),
             shoulder = shoulder_at(grid, at(Part::kShoulder), params_.shoulder_depth_m, depths_m_);
  if (!hand) return no_depth(arm, Part::kHand);
  if (!elbow) return no_depth(arm, Part::kElbow);
  if (!shoulder) return no_depth(arm, Part::kShoulder);
  hand_.p = *hand;
  elbow_.p = *elbow;
  shoulder_.p = *shoulder;
  lengths_ = chain().lengths();
  DUO_TRY(check_lengths(lengths_));
  first_upper_ = normalized(elbow_.p - shoulder_.p);
  first_elbow_ = elbow_.p;
  first_shoulder_ = shoulder_.p;
  first_ray_ = (1 / shoulder_.p.z) * shoulder_.p;
  shoulder_misses_m_.reserve(static_cast<std::size_t>(kLearnShoulderS / frame_s_) + 1);
  torso_.start(shoulder_.p);
  return learn_first(scene, find_person(grid));
}

/// The surfaces under the clicks; the background is learnt from the rest.
std::vector<std::uint8_t> Arm::find_person(const Grid& grid) {
  constexpr double kBodyM = 1.1, kDepthM = 0.45, kStepM = 0.02;
  constexpr double kAtShoulderM = 0.09, kAtElbowM = 0.07, kAtHandM = 0.05;
  constexpr double kFurnitureM2 = 0.06;  // smaller things at the person's depth stay unknown until they move or are seen behind
  for (int i = 0; i < grid.size(); ++i) {
    const Vec3 p = grid.point(i);
    mask_[static_cast<std::size_t>(i)] = grid.known(i) && grid.inside[static_cast<std::size_t>(i)] &&
                                         norm(p - shoulder_.p) < kBodyM && std::abs(p.z - shoulder_.p.z) < kDepthM;
  }
  const auto clicked = [&](int i) {
    const Vec3 p = grid.point(i);
    return norm(p - shoulder_.p) < kAtShoulderM || norm(p - hand_.p) < kAtHandM || norm(p - elbow_.p) < kAtElbowM;
  };
  std::vector<std::uint8_t> person(mask_.size()), unknown(mask_.size());
  for (const Region& r : skin_regions_.find(grid, mask_, kStepM)) {
    const bool mine = std::any_of(r.cells.begin(), r.cells.end(), clicked);
    for (const int i : r.cells) {
      person[static_cast<std::size_t>(i)] = mine;
      unknown[static_cast<std::size_t>(i)] = mine || r.area_m2 < kFurnitureM2;
    }
  }
  background_.start(grid, unknown);
  return person;
}

Result<void> Arm::learn_first(const Scene& scene, const std::vector<std::uint8_t>& person) {
  constexpr double kHandM = 0.06, kClothM = 0.75;
  const Grid& grid = scene.grid;
  const Chain arm = chain();
  const auto mine = [&](int i) { return person[static_cast<std::size_t>(i)] != 0; };
  const auto skin = histogram_of(grid, [&](int i) { return mine(i) && norm(grid.point(i) - arm.hand) < kHandM; });
  if (!skin)
    return Error{ErrorCode::kBadInput,
                 "select the arm: no surface around the hand click; click the middle of the hand, or choose another frame"};
  const auto cloth = histogram_of(grid, [&](int i) {
    const Vec3 p = grid.point(i);
    return mine(i) && norm(p - arm.shoulder) < kClothM && arm.distance(p) > 0.10 && norm(p - arm.hand) > 0.15;
  });
  colors_.start(*skin, cloth.value_or(Histogram{}));
  learn_others(grid, person);

  const Rigid3 torso_from_rig = inverse(torso_.rig_from_torso());
  const auto learn_far = [&](BodyMap& map, const std::vector<std::uint8_t>& mask, const Clearance& from_arm) {
    for (std::size_t i = 0; i < mask.size(); ++i) scratch_[i] = mask[i] && from_arm.holds(arm, grid.point(static_cast<int>(i)));
    map.learn(grid, scratch_, torso_from_rig, BodyMap::kStart);
  };
  learn_far(body_skin_, mask_, {0.22, 0.13, 0.13});
  learn_far(body_, person, {0.20, 0.11, 0.11});

  for (int i = 0; i < grid.size(); ++i) {
    const Vec3 p = grid.point(i), local = p - arm.shoulder;
    mask_[static_cast<std::size_t>(i)] = mine(i) && norm(local) > 0.03 && norm(local) < 0.45 && local.y > -0.10 &&
                                         std::abs(local.z) < 0.2 && arm.distance(p) > 0.09;
  }
  torso_.add_patches(grid, scene.gray, mask_);
  learn_hand_length(grid);
  return {};
}

/// Leaves in mask_ the skin of the person; regions of it away from the arm are the head (above the shoulder) and another hand.
void Arm::learn_others(const Grid& grid, const std::vector<std::uint8_t>& person) {
  constexpr float kSkin = 1;
  constexpr double kLeastM2 = 0.003, kTouchM = 0.08, kFromArmM = 0.10;
  const Chain arm = chain();
  for (std::size_t i = 0; i < mask_.size(); ++i) mask_[i] = person[i] && colors_(grid.color_bin(static_cast<int>(i))) > kSkin;
  keep_majority(grid, mask_, scratch_, 6);
  for (const Region& r : skin_regions_.find(grid, mask_, params_.region_step_m)) {
    const auto touches = [&](int i) {
      const Vec3 p = grid.point(i);
      return norm(p - arm.hand) < kTouchM || norm(p - arm.elbow) < kTouchM;
    };
    if (r.area_m2 < kLeastM2 || arm.distance(r.mean) < kFromArmM || std::any_of(r.cells.begin(), r.cells.end(), touches))
      continue;
    if (others_.size() == kMostOwnOthers) break;
    others_.push_back({r.mean, r.mean - arm.shoulder, r.mean.y < arm.shoulder.y, 0});
  }
  own_others_ = others_.size();
}

/// How far this hand's centre lies from its fingertips: half from the clicks, half from anatomy.
void Arm::learn_hand_length(const Grid& grid) {
  constexpr double kAtHandM = 0.05, kAroundM = 0.2, kLeastM = 0.07, kMostM = 0.14;
  hand_centre_m_ = params_.hand_centre_m;
  find_silhouette(grid, {});
  const Gate gate{hand_.p, kAroundM};
  double clicked_m = params_.hand_centre_m;
  for (const Region& r : skin_regions_.find(grid, silhouette_.skin, params_.region_step_m)) {
    const auto at_hand = [&](int i) { return norm(grid.point(i) - hand_.p) <= kAtHandM; };
    if (!std::any_of(r.cells.begin(), r.cells.end(), at_hand)) continue;
    const auto seen = hands_.find(grid, silhouette_, r.cells, elbow_.p, lengths_.fore_m, hand_centre_m_, &gate, params_);
    if (seen) clicked_m = std::clamp(seen->tip_m - lengths_.fore_m, kLeastM, kMostM);
  }
  hand_centre_m_ = 0.5 * (clicked_m + params_.hand_centre_m);
}

}  // namespace duo::arm
