#include "sources/synthetic/lens.h"

#include <cmath>

namespace duo::synthetic {
namespace {

struct Bent {
  Point2 at;
  double xx, xy, yy;  // derivatives; d at.x / dy = d at.y / dx
};

// The first five of OpenCV's coefficients; the rigs made here have no others.
Bent bend(const Camera& camera, Point2 p) {
  const auto& [k1, k2, p1, p2, k3, k4, k5, k6] = camera.distortion;
  const double xx = p.x * p.x, yy = p.y * p.y, xy = p.x * p.y, r2 = xx + yy;
  const double radial = 1 + r2 * (k1 + r2 * (k2 + r2 * k3));
  const double slope = 2 * (k1 + r2 * (2 * k2 + r2 * 3 * k3));  // of radial along r2, times 2
  return {{p.x * radial + 2 * p1 * xy + p2 * (r2 + 2 * xx), p.y * radial + p1 * (r2 + 2 * yy) + 2 * p2 * xy},
          radial + slope * xx + 2 * p1 * p.y + 6 * p2 * p.x,
          slope * xy + 2 * p1 * p.x + 2 * p2 * p.y,
          radial + slope * yy + 6 * p1 * p.y + 2 * p2 * p.x};
}

}  // namespace

Point2 project(const Camera& camera, Point2 on_plane) {
  const Point2 bent = bend(camera, on_plane).at;
  return {camera.fx_px * bent.x + camera.cx_px, camera.fy_px * bent.y + camera.cy_px};
}

Point2 unproject(const Camera& camera, Point2 pixel) {
  constexpr double kClose = 1e-6;  // the step from there is right to 1e-12: Newton's method squares the error
  constexpr int kMaxSteps = 12;
  const Point2 want{(pixel.x - camera.cx_px) / camera.fx_px, (pixel.y - camera.cy_px) / camera.fy_px};
  if (camera.distortion == std::array<double, 8>{}) return want;
  Point2 p = want;
  for (int i = 0; i < kMaxSteps; ++i) {
    const Bent b = bend(camera, p);
    const double ex = b.at.x - want.x, ey = b.at.y - want.y;
    const double det = b.xx * b.yy - b.xy * b.xy;
    p.x -= (b.yy * ex - b.xy * ey) / det;
    p.y -= (b.xx * ey - b.xy * ex) / det;
    if (std::abs(ex) < kClose && std::abs(ey) < kClose) break;
  }
  return p;
}

}  // namespace duo::synthetic
