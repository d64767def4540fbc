// Which parts of space belong to the body, in voxels of the torso frame: head, other arm, chest.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "trackers/arm/grid.h"

namespace duo::arm {

class BodyMap {
 public:
  static constexpr int kStart = 10, kGlimpse = 1;  // votes of the first frame and of a later one

  /// Votes for the voxels that at least three cells of the mask fall in.
  void learn(const Grid& grid, const std::vector<std::uint8_t>& mask, const Rigid3& torso_from_rig, int votes);
  bool holds(Vec3 p_in_torso_m) const {
    const int v = voxel(p_in_torso_m);
    return v >= 0 && votes_[static_cast<std::size_t>(v)] >= kLeastVotes;
  }
  /// The same with half a voxel of tolerance along each axis.
  bool holds_nearby(Vec3 p_in_torso_m) const;

 private:
  static constexpr int kSide = 32, kLeastVotes = 6;
  static constexpr double kVoxelM = 0.05;
  static int voxel(Vec3 p_in_torso_m);
  std::vector<std::uint8_t> votes_ = std::vector<std::uint8_t>(kSide * kSide * kSide), hits_ = votes_;
};

}  // namespace duo::arm
