#include "sources/synthetic/noise.h"

#include <algorithm>

namespace duo::synthetic {

double noise(Vec3 p, std::uint32_t seed) {
  const int x = floor_int(p.x), y = floor_int(p.y), z = floor_int(p.z);
  const auto ease = [](double t) { return t * t * (3 - 2 * t); };
  const double u = ease(p.x - x), v = ease(p.y - y), w = ease(p.z - z);
  const auto mixed = [](double a, double b, double t) { return a + (b - a) * t; };
  const auto along_x = [&](int dy, int dz) {
    return mixed(unit(hash(seed, x, y + dy, z + dz)), unit(hash(seed, x + 1, y + dy, z + dz)), u);
  };
  return mixed(mixed(along_x(0, 0), along_x(1, 0), v), mixed(along_x(0, 1), along_x(1, 1), v), w);
}

double fbm(Vec3 p, int octaves, double footprint, std::uint32_t seed) {
  double sum = 0.5, amplitude = 0.5, frequency = 1;
  for (int i = 0; i < octaves; ++i) {
    const double keep = std::clamp(2 - 2 * footprint * frequency, 0.0, 1.0);
    if (keep == 0) break;
    // Octaves are shifted against each other, or lattice points would line up at the origin.
    sum +=
        amplitude * keep * (noise(frequency * p + Vec3{7.3 * i, 3.1 * i, 5.7 * i}, seed + static_cast<std::uint32_t>(i)) - 0.5);
    amplitude *= 0.5;
    frequency *= 2;
  }
  return sum;
}

double sin_turns(double turns) {
  // To [-1/4, 1/4] by symmetry, then the Taylor series to x^15: error below 1e-13 at pi/2.
  double x = turns - std::floor(turns + 0.5);
  if (x > 0.25) x = 0.5 - x;
  if (x < -0.25) x = -0.5 - x;
  x *= 6.283185307179586;
  double term = x, sum = x;
  for (int n = 2; n <= 16; n += 2) {
    term *= -x * x / (n * (n + 1));
    sum += term;
  }
  return sum;
}

Mat3 about_x(double degrees) {
  const double s = sin_turns(degrees / 360), c = cos_turns(degrees / 360);
  return {{1, 0, 0, 0, c, -s, 0, s, c}};
}
Mat3 about_y(double degrees) {
  const double s = sin_turns(degrees / 360), c = cos_turns(degrees / 360);
  return {{c, 0, s, 0, 1, 0, -s, 0, c}};
}
Mat3 about_z(double degrees) {
  const double s = sin_turns(degrees / 360), c = cos_turns(degrees / 360);
  return {{c, -s, 0, s, c, 0, 0, 0, 1}};
}

}  // namespace duo::synthetic
