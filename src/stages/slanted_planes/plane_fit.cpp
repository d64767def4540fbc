#include "stages/slanted_planes/plane_fit.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "core/check.h"
#include "duoptic/frame.h"

namespace duo {
namespace {

void fit_rows(const PlaneFit& in, int begin, int end, PlaneMap& planes) {
  for (int y = begin; y < end; ++y)
    for (int x = 0; x < in.d_q4.width(); ++x) planes.set(y, x, fitted_plane(in, y, x));
}

}  // namespace

Plane fitted_plane(const PlaneFit& in, int y, int x) {
  const int own = in.d_q4.at(y, x);
  if (own == Disparity::kNone) return {};
  std::int64_t n = 0, sx = 0, sy = 0, sd = 0, sxx = 0, sxy = 0, syy = 0, sxd = 0, syd = 0;
  for (int j = -PlaneFit::kRadius; j <= PlaneFit::kRadius; j += PlaneFit::kStep) {
    if (y + j < 0 || y + j >= in.d_q4.height()) continue;
    for (int i = -PlaneFit::kRadius; i <= PlaneFit::kRadius; i += PlaneFit::kStep) {
      if (x + i < 0 || x + i >= in.d_q4.width()) continue;
      const int d = in.d_q4.at(y + j, x + i) - own;
      if (std::abs(d) > PlaneFit::kSame_q4 + 2 * std::max(std::abs(i), std::abs(j))) continue;
      const int w = slanted_weight(in.guide.at(y, x), in.guide.at(y + j, x + i));
      n += w, sx += w * i, sy += w * j, sd += w * d, sxx += w * i * i, sxy += w * i * j, syy += w * j * j;
      sxd += w * i * d, syd += w * j * d;
    }
  }
  const auto about_mean = [n](std::int64_t sum, std::int64_t a, std::int64_t b) {
    return static_cast<double>(sum * n - a * b);
  };
  const auto drawn = static_cast<double>(2 * n * n);
  const double xx = about_mean(sxx, sx, sx) + drawn, yy = about_mean(syy, sy, sy) + drawn, xy = about_mean(sxy, sx, sy);
  const double xd = about_mean(sxd, sx, sd), yd = about_mean(syd, sy, sd), area = xx * yy - xy * xy;
  const double along_x = (xd * yy - yd * xy) / area, along_y = (yd * xx - xd * xy) / area;
  const double here = (static_cast<double>(sd) - along_x * static_cast<double>(sx) - along_y * static_cast<double>(sy)) /
                      static_cast<double>(n);
  constexpr int kPerSixteenth = Plane::kOne / 16;
  const auto slope = [](double along_q4) {
    return static_cast<std::int32_t>(std::llround(std::clamp(along_q4 * kPerSixteenth, -1.0 * Plane::kOne, 1.0 * Plane::kOne)));
  };
  const auto d = static_cast<std::int32_t>(own * kPerSixteenth + std::llround(here * kPerSixteenth));
  return {std::clamp(d, 0, (in.max_disparity - 1) << Plane::kBits), slope(along_x), slope(along_y)};
}

void ref::fit_planes(const PlaneFit& in, PlaneMap& planes) {
  DUO_CHECK(in.guide.size() == in.d_q4.size() && planes.size() == in.d_q4.size());
  fit_rows(in, 0, in.d_q4.height(), planes);
}
void simd::fit_planes(Pool& pool, const PlaneFit& in, PlaneMap& planes) {
  DUO_CHECK(in.guide.size() == in.d_q4.size() && planes.size() == in.d_q4.size());
  pool.rows(in.d_q4.height(), [&](int begin, int end) { fit_rows(in, begin, end, planes); });
}

}  // namespace duo
