#include "calib/opencv_rectified.h"

#include <algorithm>
#include <opencv2/calib3d.hpp>
#include <opencv2/core/persistence.hpp>
#include <span>

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

void put(cv::FileStorage& storage, const char* key, int rows, std::span<const double> numbers) {
  storage << key << cv::Mat(rows, static_cast<int>(numbers.size()) / rows, CV_64F, const_cast<double*>(numbers.data()));
}

void put(cv::FileStorage& storage, const char* matrix_key, const char* distortion_key, const Camera& c) {
  put(storage, matrix_key, 3, std::array{c.fx_px, 0.0, c.cx_px, 0.0, c.fy_px, c.cy_px, 0.0, 0.0, 1.0});
  put(storage, distortion_key, 1, std::span(c.distortion).first(has_denominator(c) ? 8 : 5));
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

OpencvRectified opencv_rectified(const Rectified& r) {
  const double f = r.focal_px, cx = r.cx_px, cy = r.cy_px, b = r.baseline_m;
  return {r.rig_from_left,
          r.rig_from_right,
          {f, 0, cx, 0, 0, f, cy, 0, 0, 0, 1, 0},
          {f, 0, cx, -f * b, 0, f, cy, 0, 0, 0, 1, 0},
          {1, 0, 0, -cx, 0, 1, 0, -cy, 0, 0, 0, f, 0, 0, 1 / b, 0}};
}

std::string opencv_text(const Rig& rig, const OpencvRectified& rectified, bool yaml) {
  const Vec3 t = rig.right_from_left.t_m;
  cv::FileStorage storage(yaml ? ".yml" : ".json", cv::FileStorage::WRITE | cv::FileStorage::MEMORY);
  storage << "image_width" << rig.left.size.width << "image_height" << rig.left.size.height;
  put(storage, "M1", "D1", rig.left);
  put(storage, "M2", "D2", rig.right);
  put(storage, "R", 3, rig.right_from_left.rotation.m);
  put(storage, "T", 3, std::array{t.x, t.y, t.z});
  put(storage, "R1", 3, rectified.r1.m);
  put(storage, "R2", 3, rectified.r2.m);
  put(storage, "P1", 3, rectified.p1);
  put(storage, "P2", 3, rectified.p2);
  put(storage, "Q", 4, rectified.q);
  return storage.releaseAndGetString();
}

}  // namespace duo
