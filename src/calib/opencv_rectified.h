// A rig and its rectification as OpenCV writes them: what programs that read OpenCV's and ROS's files expect.
#pragma once

#include <array>
#include <string>

#include "duoptic/rig.h"

namespace duo {

/// Units  p1, p2, q row by row; metres
struct OpencvRectified {
  Mat3 r1, r2;  // rectified_from_left, rectified_from_right
  std::array<double, 12> p1{}, p2{};
  std::array<double, 16> q{};  // (x, y, disparity, 1) to homogeneous metres
};

/// stereoRectify with CALIB_ZERO_DISPARITY and alpha 0: pictures of the raw size without black borders.
OpencvRectified opencv_rectified(const Rig& rig);
/// Our own rectification in the same words.
OpencvRectified opencv_rectified(const Rectified& rectified);

/// A file of OpenCV's FileStorage.
std::string opencv_text(const Rig& rig, const OpencvRectified& rectified, bool yaml);

/// Whether k4 k5 k6 are used.
inline bool has_denominator(const Camera& camera) {
  return camera.distortion[5] != 0 || camera.distortion[6] != 0 || camera.distortion[7] != 0;
}

}  // namespace duo
