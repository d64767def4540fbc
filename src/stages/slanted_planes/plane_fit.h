// A plane for each pixel of a disparity map: where slanted planes begin.
#pragma once

#include "stages/slanted_planes/slanted_planes.h"

namespace duo {

/// The plane of least squares through the disparities around a pixel.
///
/// Taps: every second pixel of the 17x17 around it that is in the picture and whose disparity differs by at most 16 + 2 m in
/// 1/16 px from the pixel's, m the larger of its distances along x and y. Weights as of slanted planes. Slopes are drawn
/// towards 0, as if their spread were larger by 2 px^2, and held to 1.
///
/// Shape    guide, d_q4 and planes H x W; a hole gets disparity 0
/// Threads  pixels are independent; simd runs the plain loops on all threads
/// Exact    whole sums, below 2^31; the slopes are IEEE doubles in a fixed order
struct PlaneFit {
  static constexpr int kRadius = 8, kStep = 2, kSame_q4 = 16;
  View<const Rgb8> guide;
  View<const std::uint16_t> d_q4;
  int max_disparity = 0;
};
Plane fitted_plane(const PlaneFit& in, int y, int x);

namespace ref {
void fit_planes(const PlaneFit& in, PlaneMap& planes);
}
namespace simd {
void fit_planes(Pool& pool, const PlaneFit& in, PlaneMap& planes);
}

}  // namespace duo
