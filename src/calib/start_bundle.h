// Where bundle adjustment starts: each camera calibrated alone, the pose between them that most views agree on.
#pragma once

#include <vector>

#include "calib/bundle.h"

namespace duo {

struct BundleStart {
  Bundle bundle;
  double pose_spread_rad = 0;  // how far the views' poses between the cameras are turned from the agreed one, median
};

/// `views` have the board in both pictures, four of them or more.
///
/// Errors  OpenCV finds no camera that fits
Result<BundleStart> start_bundle(const std::vector<const BoardView*>& views, const Board& board, Size size);

/// Angle of a rotation.
double angle_rad(const Mat3& rotation);

}  // namespace duo
