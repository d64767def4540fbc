#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "core/point.h"
#include "core/rotation.h"
#include "duoptic/paint.h"
#include "duoptic/statistics.h"

namespace duo {
namespace {

constexpr double kNearest_m = 0.05;
constexpr double kFarthest = 6;  // of the middle's depth: farther points are mostly noise
constexpr int kLargest_px = 12;

}  // namespace

OrbitCamera::OrbitCamera(const Orbit& orbit, const Rectified& rectified, Size size)
    : turn_(rotation_of({orbit.pitch_rad, 0, 0}) * rotation_of({0, orbit.yaw_rad, 0})),
      middle_in_rig_m_{0, 0, orbit.middle_m},
      distance_m_(orbit.middle_m / orbit.zoom),
      focal_px_(rectified.focal_px * std::min(static_cast<double>(size.width) / rectified.size.width,
                                              static_cast<double>(size.height) / rectified.size.height)),
      cx_px_(size.width / 2.0),
      cy_px_(size.height / 2.0) {}

std::optional<Vec3> OrbitCamera::place(Vec3 p_in_rig_m) const {
  const Vec3 q = turn_ * (p_in_rig_m - middle_in_rig_m_);
  const double z_m = q.z + distance_m_;
  if (z_m < kNearest_m) return {};
  return Vec3{cx_px_ + focal_px_ * q.x / z_m, cy_px_ + focal_px_ * q.y / z_m, z_m};
}

double foreground_m(View<const std::uint16_t> d_q4, const Rectified& rectified) {
  constexpr int kStep = 4;
  std::vector<std::uint16_t> known;
  for (int y = 0; y < d_q4.height(); y += kStep)
    for (int x = 0; x < d_q4.width(); x += kStep)
      if (const std::uint16_t d = d_q4.at(y, x); d != Disparity::kNone && d != 0) known.push_back(d);
  if (known.empty()) return 0;
  return rectified.depth_m(nth(known, known.size() * 3 / 4) / 16.0);
}

void draw_points(View<const std::uint16_t> d_q4, View<const Rgb8> color, const Rectified& rectified, const OrbitCamera& camera,
                 View<Rgb8> dst) {
  const Size size = dst.size();
  Image<float> nearest_m(size);
  for (int y = 0; y < size.height; ++y) {
    const double down = static_cast<double>(y) / size.height;
    const auto shade = [down](double top, double bottom) { return static_cast<std::uint8_t>(top + (bottom - top) * down); };
    std::fill_n(dst.row(y), size.width, Rgb8{shade(40, 16), shade(44, 18), shade(53, 22)});
    std::fill_n(nearest_m.row(y), size.width, std::numeric_limits<float>::max());
  }
  const double far_m = kFarthest * camera.middle_m();
  for (int y = 0; y < d_q4.height(); ++y)
    for (int x = 0; x < d_q4.width(); ++x) {
      const auto p = point_at(d_q4, rectified, y, x);
      if (!p || p->z > far_m) continue;
      const auto at = camera.place(*p);
      if (!at) continue;
      // A pixel's side in space, seen from here; a little more closes the gaps of slanted surfaces.
      const double side_px = camera.focal_px() * p->z / rectified.focal_px / at->z;
      const int side = std::clamp(static_cast<int>(std::ceil(1.2 * side_px)), 1, kLargest_px);
      const int left = static_cast<int>(at->x) - side / 2, top = static_cast<int>(at->y) - side / 2;
      if (left < 0 || top < 0 || left + side > size.width || top + side > size.height) continue;
      const auto depth = static_cast<float>(at->z);
      for (int v = top; v < top + side; ++v)
        for (int u = left; u < left + side; ++u)
          if (depth < nearest_m.at(v, u)) {
            nearest_m.at(v, u) = depth;
            dst.at(v, u) = color.at(y, x);
          }
    }
}

}  // namespace duo
