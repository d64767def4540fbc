#include "calib/opencv_rectified.h"

#include <algorithm>
#include <opencv2/calib3d.hpp>

namespace duo {
namespace {

cv::Matx33d matrix_of(const Camera& c) { return {c.fx_px, 0, c.cx_px, 0, c.fy_px, c.cy_px, 0, 0, 1}; }
cv::Mat distortion_of(const Camera& c) {
  return cv::Mat(1, has_denominator(c) ? 8 : 5, CV_64F, const_cast<double*>(c.distortion.data()));
}

template <class Numbers>
void copy(const cv::Mat& from, Numbers& to) {
  std::copy_n(from.ptr<double>(), to.size(), to.begin());
}

}  // namespace

OpencvRectified opencv_rectified(const Rig& rig) {
  const Vec3 t = rig.right_from_left.t_m;
  const cv::Matx33d r(rig.right_from_left.rotation.m.data());
  cv::Mat r1, r2, p1, p2, q;
  cv::stereoRectify(matrix_of(rig.left), distortion_of(rig.left), matrix_of(rig.right), distortion_of(rig.right),
                    {rig.left.size.width, rig.left.size.height}, r, cv::Vec3d(t.x, t.y, t.z), r1, r2, p1, p2, q,
                    cv::CALIB_ZERO_DISPARITY, 0);
  OpencvRectified out;
  copy(r1, out.r1.m);
  copy(r2, out.r2.m);
  copy(p1, out.p1);
  copy(p2, out.p2);
  copy(q, out.q);
  return out;
}

}  // namespace duo
