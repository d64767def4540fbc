// Randomness and elementary functions that give the same bits on every machine: integer hashes, +, -, *, / and sqrt only.
#pragma once

#include <cmath>
#include <cstdint>

#include "duoptic/geometry.h"

namespace duo::synthetic {

/// Source  Wellons, "Prospecting for hash functions", 2018 (lowbias32)
inline std::uint32_t mix(std::uint32_t x) {
  x = (x ^ (x >> 16)) * 0x7feb352dU;
  x = (x ^ (x >> 15)) * 0x846ca68bU;
  return x ^ (x >> 16);
}

/// One number for a point of a lattice.
inline std::uint32_t hash(std::uint32_t seed, int x, int y = 0, int z = 0) {
  return mix(seed ^ (static_cast<std::uint32_t>(x) * 0x8da6b343U) ^ (static_cast<std::uint32_t>(y) * 0xd8163841U) ^
             (static_cast<std::uint32_t>(z) * 0xcb1ab31fU));
}

/// floor(x) for |x| < 2^31 without the call that it is before SSE4.
inline int floor_int(double x) {
  const int toward_zero = static_cast<int>(x);
  return toward_zero - (x < toward_zero ? 1 : 0);
}

/// A hash as a number in [0, 1).
inline double unit(std::uint32_t h) { return h * (1.0 / 4294967296.0); }

/// A stream of numbers; streams of different seeds are independent.
class Random {
 public:
  explicit Random(std::uint32_t seed) : seed_(mix(seed + 0x9e3779b9U)) {}
  std::uint32_t bits() { return hash(seed_, static_cast<int>(count_++)); }
  double uniform(double low, double high) { return low + (high - low) * unit(bits()); }
  /// A whole number in [0, n).
  int pick(int n) { return static_cast<int>(unit(bits()) * n); }

 private:
  std::uint32_t seed_, count_ = 0;
};

/// Value noise on the integer lattice, smooth, mean 0.5.
///
/// Units  result in [0, 1]
double noise(Vec3 p, std::uint32_t seed);

/// Sum of `octaves` noises of doubled frequency and halved amplitude. An octave too fine for the sampling distance
/// `footprint` (in the units of p) fades to its mean, so that textures do not alias.
///
/// Units  result in [0, 1], mean 0.5
double fbm(Vec3 p, int octaves, double footprint, std::uint32_t seed);

/// Sine and cosine of an angle counted in turns.
double sin_turns(double turns);
inline double cos_turns(double turns) { return sin_turns(turns + 0.25); }

/// Turns about the x, y or z axis by `degrees`, right-handed (with y down: positive about y turns z towards x).
Mat3 about_x(double degrees);
Mat3 about_y(double degrees);
Mat3 about_z(double degrees);

inline double fract(double x) { return x - floor_int(x); }
inline double smoothstep(double low, double high, double x) {
  const double t = x <= low ? 0 : x >= high ? 1 : (x - low) / (high - low);
  return t * t * (3 - 2 * t);
}

}  // namespace duo::synthetic
