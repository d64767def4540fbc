// The second opinion of the thesis: points stored around each joint, found again in its window.
#pragma once

#include <optional>
#include <vector>

#include "core/pool.h"
#include "core/sift_points.h"
#include "stages/match_points/match_points.h"
#include "stages/sift/sift.h"
#include "trackers/arm/pinhole.h"

namespace duo::arm {

/// The points of one joint with their way to it.
struct JointPoints {
  SiftPoints points;
  std::vector<Vec2> to_joint_px;
};

class PointFinder {
 public:
  static constexpr int kCapacity = 256;  // points in a window; a textured one of 107 px gives about 100
  PointFinder() = default;
  explicit PointFinder(Size largest_window);

  void learn(Pool& pool, const Image<std::uint8_t>& gray, const Window& window, Vec2 joint_px, JointPoints& out);
  /// Where the points say that the joint is: the median over matches. None of fewer than three.
  std::optional<Vec2> find(Pool& pool, const Image<std::uint8_t>& gray, const Window& window, const JointPoints& stored);

 private:
  SiftParams params_;
  std::optional<SiftScratch> scratch_;
  SiftPoints seen_;
  std::vector<PointMatch> matches_;
  std::vector<double> x_px_, y_px_;
};

}  // namespace duo::arm
