// Bundle adjustment of two cameras and the boards they saw: both lenses, the pose between them, a pose for each view.
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "duoptic/calibrate.h"

namespace duo {

/// Shared parameters in their order: left fx fy cx cy k1 k2 p1 p2 k3, the right camera's nine, then the pose right_from_left:
/// a turn (radians, around the right camera's axes) and a move (metres).
inline constexpr int kCameraParameters = 9, kShared = 24;
using Shared = Eigen::Matrix<double, kShared, 1>;
using SharedMatrix = Eigen::Matrix<double, kShared, kShared>;

struct BoardPose {
  Rigid3 left_from_board;
  std::array<double, 2> rms_px{};  // of its corners in each picture
};

struct Bundle {
  Camera left, right;
  Rigid3 right_from_left;
  std::vector<BoardPose> poses;                    // one a view
  std::array<double, 2> sigma_px = {0.1, 0.1};     // robust noise of one coordinate, each camera
  std::array<bool, 2> with_k3 = {false, false};    // else k3 is held where it is
  SharedMatrix covariance = SharedMatrix::Zero();  // of the residuals, scaled by them
  SharedMatrix jackknife = SharedMatrix::Zero();   // of leaving out each view
};

/// Moves all parameters to the least squares of corners (weights after Huber, one noise level a camera), Levenberg-Marquardt on
/// the shared parameters with the poses eliminated; then fills in noise and both covariances.
///
/// `views` and `bundle.poses` go together.
///
/// Returns  false when the views do not determine the parameters
/// Source   Hartley & Zisserman, "Multiple View Geometry", 2nd ed., A6.3 and ch. 5.2
bool adjust(const std::vector<const BoardView*>& views, const Board& board, Bundle& bundle);

/// Moves only the poses: boards measured with a rig that is known.
void adjust_poses(const std::vector<const BoardView*>& views, const Board& board, Bundle& bundle);

/// The bundle with its shared parameters moved by `step`.
Bundle moved(const Bundle& bundle, const Shared& step);

/// Predicted place of a board's point, camera 0 left or 1 right.
Eigen::Vector2d predict(const Bundle& bundle, int camera, const BoardPose& pose, Vec3 p_on_board_m);

}  // namespace duo
