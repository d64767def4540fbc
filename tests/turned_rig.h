// Rigs with a turned camera, and how far a found rig lies from the true one.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "calib/rectification.h"
#include "core/lens.h"

namespace duo::test {

inline constexpr double kDeg = std::numbers::pi / 180;

inline Mat3 turn(double x_deg, double y_deg, double z_deg) {
  const auto c = [](double a) { return std::cos(a * kDeg); };
  const auto s = [](double a) { return std::sin(a * kDeg); };
  const Mat3 x{{1, 0, 0, 0, c(x_deg), -s(x_deg), 0, s(x_deg), c(x_deg)}},
      y{{c(y_deg), 0, s(y_deg), 0, 1, 0, -s(y_deg), 0, c(y_deg)}}, z{{c(z_deg), -s(z_deg), 0, s(z_deg), c(z_deg), 0, 0, 0, 1}};
  return z * y * x;
}
/// The rig of before a camera was turned in its place.
inline Rig right_turned(const Rig& rig, const Mat3& by) {
  Rig out = rig;
  out.right_from_left = Rigid3{by, {}} * rig.right_from_left;
  return out;
}
inline Rig left_turned(const Rig& rig, const Mat3& by) {
  Rig out = rig;
  out.right_from_left = rig.right_from_left * inverse(Rigid3{by, {}});
  return out;
}

/// Turn of the right camera to the left one that `rig` has and `truth` has not, degrees around x, y, z.
inline Vec3 wrong_turn_deg(const Rig& rig, const Rig& truth) {
  const Mat3 r = rig.right_from_left.rotation * transposed(truth.right_from_left.rotation);
  return (0.5 / kDeg) * Vec3{r(2, 1) - r(1, 2), r(0, 2) - r(2, 0), r(1, 0) - r(0, 1)};
}

/// Root mean square of the row differences that a rig gives to true points all over both views at 0.7 to 5 m.
inline double true_row_error_px(const Rig& rig, const Rig& truth) {
  const auto geometry = rectified_geometry(rig, "found");
  EXPECT_TRUE(geometry);
  if (!geometry) return 1e9;
  const Lens left(truth.left), right(truth.right), left_as_found(rig.left), right_as_found(rig.right);
  double sum = 0;
  int count = 0;
  for (double x = 0; x < truth.left.size.width; x += truth.left.size.width / 20.0)
    for (double y = 0; y < truth.left.size.height; y += truth.left.size.height / 15.0)
      for (const double z_m : {0.7, 1.5, 5.0}) {
        const auto seen = right.pixel_of(truth.right_from_left * (z_m * *left.ray_of({x, y})));
        if (!seen || !right.covers(*seen)) continue;
        const auto a = rectified_from_raw(*geometry, geometry->rig_from_left, left_as_found, {x, y});
        const auto b = rectified_from_raw(*geometry, geometry->rig_from_right, right_as_found, *seen);
        if (!a || !b) continue;
        sum += (a->y - b->y) * (a->y - b->y);
        ++count;
      }
  EXPECT_GT(count, 300);
  return std::sqrt(sum / count);
}

}  // namespace duo::test
