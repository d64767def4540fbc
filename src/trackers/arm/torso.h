// The torso as a rigid body, held by patches of the clothes: what carries the shoulder.
#pragma once

#include <cstdint>
#include <vector>

#include "trackers/arm/grid.h"
#include "trackers/arm/patches.h"

namespace duo::arm {

/// A point of the torso seen in the picture.
///
/// Units   pixels of the full gray level; d_px: disparity in those, 0 = unknown
struct TorsoPoint {
  Vec3 p_in_torso_m;
  Vec2 at_px;
  double d_px = 0;
};

struct TorsoFit {
  Rigid3 rig_from_torso;
  int inliers = 0;
};

/// The pose that explains the points best, from a predicted one.
///
/// Gauss-Newton on (u, v, d). Weights fall with the residual (Cauchy's, squared), its scale goes from 12 px down to 2. Few
/// points leave the pose near the prediction.
///
/// Source  Blake, Zisserman, "Visual Reconstruction", 1987 (graduated non-convexity)
TorsoFit fit_torso(const Pinhole& camera, const std::vector<TorsoPoint>& points, const Rigid3& predicted);

class Torso {
 public:
  static constexpr std::size_t kMostPatches = 160;

  Torso();
  /// The torso frame starts at `origin`, with the axes of the rig.
  void start(Vec3 origin);
  /// Cuts new patches where the mask of cells is set.
  void add_patches(const Grid& grid, const GrayLevels& gray, const std::vector<std::uint8_t>& mask);
  /// predict, observe, update in one: the pose in this frame.
  void track(const Grid& grid, const GrayLevels& gray);

  const Rigid3& rig_from_torso() const { return pose_; }
  /// What the torso did since the last frame.
  Vec3 moved(Vec3 p) const { return pose_ * (inverse(last_) * p); }
  bool seen() const { return unseen_ == 0; }
  int unseen() const { return unseen_; }
  int inliers() const { return inliers_; }

 private:
  struct Corner {
    double strength;
    int x, y;
  };
  Rigid3 predicted() const;
  void find_corners(const Grid& grid, const GrayLevels& gray, const std::vector<std::uint8_t>& mask);

  Rigid3 pose_, last_;
  std::vector<Patch> patches_;
  std::vector<TorsoPoint> points_;
  std::vector<Corner> corners_;
  int inliers_ = 0, unseen_ = 0;
};

}  // namespace duo::arm
