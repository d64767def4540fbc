#include "trackers/arm/body_map.h"

#include <algorithm>
#include <cmath>

namespace duo::arm {

int BodyMap::voxel(Vec3 p) {
  const int x = static_cast<int>(std::floor(p.x / kVoxelM)) + kSide / 2,
            y = static_cast<int>(std::floor(p.y / kVoxelM)) + kSide / 2,
            z = static_cast<int>(std::floor(p.z / kVoxelM)) + kSide / 2;
  const auto inside = [](int k) { return k >= 0 && k < kSide; };
  return inside(x) && inside(y) && inside(z) ? (z * kSide + y) * kSide + x : -1;
}

bool BodyMap::holds_nearby(Vec3 p) const {
  constexpr double k = kVoxelM / 2;
  for (const Vec3 step : {Vec3{}, {k, 0, 0}, {-k, 0, 0}, {0, k, 0}, {0, -k, 0}, {0, 0, k}, {0, 0, -k}})
    if (holds(p + step)) return true;
  return false;
}

void BodyMap::learn(const Grid& grid, const std::vector<std::uint8_t>& mask, const Rigid3& torso_from_rig, int votes) {
  constexpr std::uint8_t kLeastHits = 3;
  constexpr int kMostVotes = 40;
  std::fill(hits_.begin(), hits_.end(), std::uint8_t{0});
  for (int i = 0; i < grid.size(); ++i) {
    if (!mask[static_cast<std::size_t>(i)]) continue;
    const int v = voxel(torso_from_rig * grid.point(i));
    if (v >= 0 && hits_[static_cast<std::size_t>(v)] < kLeastHits) ++hits_[static_cast<std::size_t>(v)];
  }
  for (std::size_t v = 0; v < votes_.size(); ++v)
    if (hits_[v] == kLeastHits) votes_[v] = static_cast<std::uint8_t>(std::min(kMostVotes, votes_[v] + votes));
}

}  // namespace duo::arm
