// exp, cos and sin of our own: the same bits on every machine. Scalar; called a few times a point.
#pragma once

#include <algorithm>

namespace duo::sift {

/// e^x for x in [-20, 2] to 1e-8 of its value: Taylor of x / 1024, squared ten times.
inline double exponential(double x) {
  const double t = x / 1024;
  double r = 1 + t * (1 + t * (1.0 / 2 + t * (1.0 / 6 + t * (1.0 / 24))));
  for (int i = 0; i < 10; ++i) r *= r;
  return r;
}

/// scale * exp(-a i^2) for i = first, first + 1, ...: each from the one before, since the ratio of neighbours is itself
/// geometric.
inline void gaussian_row(double a, double first, double scale, int count, float* out) {
  double value = scale * exponential(-a * first * first), ratio = exponential(-a * (2 * first + 1));
  const double step = exponential(-2 * a);
  for (int i = 0; i < count; ++i, value *= ratio, ratio *= step) out[i] = static_cast<float>(value);
}

/// Cosine and sine of an angle in [0, 1] turns, to 1e-7.
inline void cos_sin(double turns, double& cos, double& sin) {
  constexpr double kQuarter = 1.5707963267948966;
  const int quadrant = static_cast<int>(4 * turns + 0.5);
  const double x = (4 * turns - quadrant) * kQuarter, z = x * x;  // |x| <= pi / 4
  const double s = x * (1 - z / 6 * (1 - z / 20 * (1 - z / 42 * (1 - z / 72))));
  const double c = 1 - z / 2 * (1 - z / 12 * (1 - z / 30 * (1 - z / 56 * (1 - z / 90))));
  switch (quadrant & 3) {
    case 0:
      cos = c, sin = s;
      break;
    case 1:
      cos = -s, sin = c;
      break;
    case 2:
      cos = -c, sin = -s;
      break;
    default:
      cos = s, sin = -c;
      break;
  }
}

// Arctangent; see there.
constexpr float kAtan[5] = {
#include "stages/sift/atan.inc"
};

}  // namespace duo::sift
