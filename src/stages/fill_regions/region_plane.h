// One robust plane through points of a disparity map.
#pragma once

#include <cstdint>
#include <span>

namespace duo {

struct PlanePoint {
  std::uint16_t y, x, d_q4;
};

/// d_q4 as a linear function of y and x, through a point.
struct RegionPlane {
  PlanePoint at{};
  std::int64_t along_x_q16 = 0, along_y_q16 = 0;
  /// Rounded to the nearest; pictures up to 2^16 px.
  int d_q4(int y, int x) const {
    return at.d_q4 + static_cast<int>((along_x_q16 * (x - at.x) + along_y_q16 * (y - at.y) + (1 << 15)) >> 16);
  }
};

/// The plane that most points lie near: of planes through three points, in 64 samples (a fixed sequence), the one with the
/// greatest sum of max(0, 24 - distance in 1/16 px) over at least 128 points, evenly spaced, the first of equals; then that of
/// least squares through the points within 1 1/2 px of it, where its sum is greater. A constant disparity, that of one of the
/// points compared, is preferred where its sum is nine tenths as great: a wall's points often cover a part of it, and the slope
/// through them is what errs beyond. Samples whose triangle has an area of less than 32 pixels are left out.
///
/// Errors  false, with fewer than 20 points, or where less than half of all are within 1 1/2 px of the plane
/// Exact   whole numbers, but for the slopes of least squares: IEEE doubles in a fixed order
/// Source  Fischler, Bolles, "Random sample consensus", 1981; scored as in Torr, Zisserman, "MLESAC", 2000; refined by least
///         squares as in Chum, Matas, Kittler, "Locally optimized RANSAC", 2003
bool region_plane(std::span<const PlanePoint> points, RegionPlane& out);

}  // namespace duo
