// What the arm learns while it is seen: the rest of the body, colours, the background, new patches.
#include <algorithm>

#include "duoptic/statistics.h"
#include "trackers/arm/arm.h"

namespace duo::arm {

void Arm::learn(const Scene& scene, const std::optional<Candidate>& seen) {
  constexpr double kSureScore = 2;
  learn_shoulder(scene.grid);
  if (seen && seen->score > kSureScore && frame_ % 2 == 0) learn_body(scene.grid);
  learn_colors(scene.grid, seen && seen->score > 0);
  background_.update(scene.grid);
  follow_others(scene.grid);
  renew_patches(scene);
}

// One frame's depth of plain cloth may be wrong by centimetres, and all frames would inherit what the click read: the median of
// the first second corrects the shoulder, and with it the upper arm that the clicks gave; then both are kept.
void Arm::learn_shoulder(const Grid& grid) {
  constexpr std::size_t kLeastFrames = 10;
  constexpr double kSameUpper = 0.8;  // cosine: elsewhere the arm covers the shoulder or lifts it
  constexpr double kMostM = 0.05;
  if (seconds(frame_) > kLearnShoulderS || !torso_.seen() || !elbow_.seen()) return;
  if (dot(normalized(elbow_.p - shoulder_.p), torso_.rig_from_torso().rotation * first_upper_) < kSameUpper) return;
  const auto found = shoulder_at(grid, grid.camera.project(shoulder_.p), params_.shoulder_depth_m, depths_m_);
  if (!found) return;
  shoulder_misses_m_.push_back(found->z - shoulder_.p.z + shoulder_behind_m_);
  if (shoulder_misses_m_.size() < kLeastFrames) return;
  shoulder_behind_m_ = std::clamp(median(shoulder_misses_m_), -kMostM, kMostM);
  lengths_.upper_m = norm(first_elbow_ - (first_shoulder_ + shoulder_behind_m_ * first_ray_));
}

void Arm::learn_body(const Grid& grid) {
  constexpr Clearance kFromSkin{0.25, 0.15, 0.13}, kFromBody{0.20, 0.13, 0.12};
  constexpr double kBodyM = 0.8;
  const Rigid3 torso_from_rig = inverse(torso_.rig_from_torso());
  const Chain arm = chain();
  mask_ = silhouette_.any_skin;
  keep_majority(grid, mask_, scratch_, 5);
  for (int i = 0; i < grid.size(); ++i)
    if (std::uint8_t& m = mask_[static_cast<std::size_t>(i)]; m) m = kFromSkin.holds(arm, grid.point(i));
  body_skin_.learn(grid, mask_, torso_from_rig, BodyMap::kGlimpse);
  if (!elbow_.seen()) return;
  for (int i = 0; i < grid.size(); ++i) {
    const auto k = static_cast<std::size_t>(i);
    mask_[k] = 0;
    if (!silhouette_.front[k]) continue;
    const Vec3 p = grid.point(i);
    mask_[k] = norm(p - shoulder_.p) <= kBodyM && kFromBody.holds(arm, p);
  }
  body_.learn(grid, mask_, torso_from_rig, BodyMap::kGlimpse);
}

// Colours are frozen while what they are learnt from is not seen.
void Arm::learn_colors(const Grid& grid, bool arm_seen) {
  constexpr double kHandM = 0.055, kTorsoM = 0.40, kFromArmM = 0.15, kNoSkin = 1;
  constexpr float kHandRate = 0.06F, kClothRate = 0.04F;
  const auto front = [&](int i) { return silhouette_.front[static_cast<std::size_t>(i)] != 0; };
  if (arm_seen) {
    const auto hand = histogram_of(grid, [&](int i) { return front(i) && norm(grid.point(i) - hand_.p) < kHandM; });
    if (hand) colors_.learn_target(*hand, kHandRate);
  }
  if (!torso_.seen()) return;
  const Rigid3 torso_from_rig = inverse(torso_.rig_from_torso());
  const auto cloth = histogram_of(grid, [&](int i) {
    if (!front(i) || colors_(grid.color_bin(i)) >= kNoSkin) return false;
    const Vec3 p = grid.point(i), local = torso_from_rig * p;
    return norm(local) < kTorsoM && local.y > 0 && norm(p - hand_.p) > kFromArmM &&
           norm(p - 0.5 * (hand_.p + elbow_.p)) > kFromArmM;
  });
  if (cloth) colors_.learn_surroundings(*cloth, kClothRate);
}

// Other hands go their own way: to the nearest skin that is not ours.
void Arm::follow_others(const Grid& grid) {
  constexpr double kSearchM = 0.15, kStepM = 0.12, kFromHandM = 0.12, kLeastM2 = 0.001;
  for (std::size_t n = 0; n < own_others_; ++n) {
    OtherSkin& other = others_[n];
    if (other.head) continue;
    for (int i = 0; i < grid.size(); ++i) {
      const auto k = static_cast<std::size_t>(i);
      mask_[k] =
          silhouette_.front[k] && colors_(grid.color_bin(i)) > params_.least_skin && norm(grid.point(i) - other.p) < kSearchM;
    }
    double nearest_m = kStepM;
    const Region* found = nullptr;
    for (const Region& r : other_regions_.find(grid, mask_, params_.region_step_m)) {
      const double d = norm(r.mean - other.p);
      if (r.area_m2 <= kLeastM2 || d >= nearest_m || norm(r.mean - hand_.p) <= kFromHandM) continue;
      nearest_m = d;
      found = &r;
    }
    if (found) other.p = found->mean;
    other.unseen = found ? 0 : other.unseen + 1;
  }
}

// The torso turns, and light changes: when few patches are found again, new ones are cut.
void Arm::renew_patches(const Scene& scene) {
  constexpr int kSure = 10, kEnough = 40, kEvery = 5;
  constexpr double kNearM = 0.03, kTorsoM = 0.45, kAboveM = 0.10, kDepthM = 0.2;
  constexpr Clearance kFromArm{0.20, 0.12, 0.10};
  if (!torso_.seen() || torso_.inliers() <= kSure || torso_.inliers() >= kEnough || frame_ % kEvery != 0) return;
  const Rigid3 torso_from_rig = inverse(torso_.rig_from_torso());
  for (int i = 0; i < scene.grid.size(); ++i) {
    const auto k = static_cast<std::size_t>(i);
    mask_[k] = 0;
    if (!silhouette_.front[k]) continue;
    const Vec3 p = scene.grid.point(i), local = torso_from_rig * p;
    mask_[k] = norm(local) > kNearM && norm(local) < kTorsoM && local.y > -kAboveM && std::abs(local.z) < kDepthM &&
               kFromArm.holds(chain(), p);
  }
  torso_.add_patches(scene.grid, scene.gray, mask_);
}

}  // namespace duo::arm
