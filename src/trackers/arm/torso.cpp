#include "trackers/arm/torso.h"

#include <algorithm>
#include <cmath>

#include "core/rotation.h"

namespace duo::arm {
namespace {

constexpr double kDisc = 2.5;  // cells: radius of the disc that gives a patch its depth

/// Where a place of the full gray level lies in the grid.
Vec2 cell_at(const Grid& grid, const GrayLevels& gray, Vec2 at_px) {
  return in_blocks(at_px, gray.camera.focal_px / grid.camera.focal_px);
}

}  // namespace

Torso::Torso() {
  patches_.reserve(kMostPatches);
  points_.reserve(kMostPatches);
}

void Torso::start(Vec3 origin) { pose_ = last_ = {Mat3{}, origin}; }

void Torso::find_corners(const Grid& grid, const GrayLevels& gray, const std::vector<std::uint8_t>& mask) {
  constexpr int kBorder = 10;
  constexpr double kLeast = 49 * 4 * 4;  // gradients of 4 levels on average
  corners_.clear();
  corners_.reserve(gray.full.pixels.size() / 4);
  for (int y = kBorder; y < gray.full.height - kBorder; y += 2)
    for (int x = kBorder; x < gray.full.width - kBorder; x += 2) {
      const double scale = grid.camera.focal_px / gray.camera.focal_px;
      const int u = static_cast<int>((x + 0.5) * scale), v = static_cast<int>((y + 0.5) * scale);
      if (!grid.contains(u, v) || !mask[static_cast<std::size_t>(grid.at(u, v))]) continue;
      if (const double strength = corner_strength(gray.full, x, y); strength > kLeast) corners_.push_back({strength, x, y});
    }
  std::sort(corners_.begin(), corners_.end(), [](const Corner& a, const Corner& b) {
    return a.strength != b.strength ? a.strength > b.strength : a.y != b.y ? a.y < b.y : a.x < b.x;
  });
}

void Torso::add_patches(const Grid& grid, const GrayLevels& gray, const std::vector<std::uint8_t>& mask) {
  constexpr std::size_t kMostNew = 90;
  constexpr double kApartPx = 9;
  const Rigid3 torso_from_rig = inverse(pose_);
  find_corners(grid, gray, mask);
  std::array<Vec2, kMostPatches> taken;
  std::size_t count = 0;
  for (const Patch& p : patches_) taken[count++] = gray.camera.project(pose_ * p.p_in_torso_m);
  const std::size_t most = std::min(kMostPatches, count + kMostNew);
  for (const Corner& c : corners_) {
    if (count == most) break;
    const Vec2 at = {static_cast<double>(c.x), static_cast<double>(c.y)};
    const auto crowded = [&](Vec2 q) { return std::hypot(q.x - at.x, q.y - at.y) < kApartPx; };
    if (std::any_of(taken.begin(), taken.begin() + static_cast<std::ptrdiff_t>(count), crowded)) continue;
    const auto z = disc_depth_m(grid, cell_at(grid, gray, at), kDisc);
    auto patch = z ? cut_patch(gray, at) : std::nullopt;
    if (!patch) continue;
    patch->first_z_m = *z;
    patch->p_in_torso_m = torso_from_rig * gray.camera.unproject(at, *z);
    patches_.push_back(*patch);
    taken[count++] = at;
  }
}

// The last motion goes on.
Rigid3 Torso::predicted() const {
  Rigid3 out = pose_;
  out.t_m = out.t_m + (pose_.t_m - last_.t_m);
  return out;
}

void Torso::track(const Grid& grid, const GrayLevels& gray) {
  constexpr double kLeastScore = 0.65;
  constexpr int kReach = 7, kReachUnseen = 9, kLeastInliers = 6;
  const Rigid3 expected = predicted();
  points_.clear();
  for (const Patch& patch : patches_) {
    const Vec3 p = expected * patch.p_in_torso_m;
    const auto match = find_patch(gray, patch, gray.camera.project(p), patch.first_z_m / p.z, seen() ? kReach : kReachUnseen);
    if (!match || match->score < kLeastScore) continue;
    const auto z = disc_depth_m(grid, cell_at(grid, gray, match->at_px), kDisc);
    points_.push_back({patch.p_in_torso_m, match->at_px, z ? gray.camera.disparity_px(*z) : 0});
  }
  const TorsoFit fit = fit_torso(gray.camera, points_, expected);
  inliers_ = fit.inliers;
  last_ = pose_;
  const bool ok = inliers_ >= kLeastInliers;
  pose_ = ok ? fit.rig_from_torso : expected;
  unseen_ = ok ? 0 : unseen_ + 1;
}

}  // namespace duo::arm
