// Slanted planes: each pixel of a view takes, of its own and its neighbours' planes and what lies near them, the one that the
// energies around it agree on.
#pragma once

#include <array>
#include <cstdint>
#include <cstdlib>
#include <vector>

#include "core/pool.h"
#include "duoptic/image.h"
#include "stages/types/energy_volume.h"

namespace duo {

/// The disparity d + dx i + dy j at i columns and j rows from the pixel.
///
/// Units   1/4096 px; slopes in that per px
struct Plane {
  static constexpr int kBits = 12, kOne = 1 << kBits, kSteepest = 2 * kOne;
  std::int32_t d = 0, dx = 0, dy = 0;
  int at(int j, int i) const { return d + dx * i + dy * j; }
  friend bool operator==(const Plane&, const Plane&) = default;
};

/// Shape   all H x W
struct PlaneMap {
  Image<std::int32_t> d, dx, dy;
  explicit PlaneMap(Size size) : d(size), dx(size), dy(size) {}
  Plane at(int y, int x) const { return {d.at(y, x), dx.at(y, x), dy.at(y, x)}; }
  void set(int y, int x, const Plane& plane) { d.at(y, x) = plane.d, dx.at(y, x) = plane.dx, dy.at(y, x) = plane.dy; }
  Size size() const { return d.size(); }
};

/// Lets the planes of a view settle.
///
/// Energy of a plane at a pixel: the sum over the taps, every second pixel of the 25x25 around it that lies in the picture, of
/// weight times the energy at the plane's disparity there, held to 0 .. max_disparity - 1 and interpolated linearly between
/// whole disparities in sixteenths (rounded down), in sixteenths. Weight: kWeights[step / 4] of the sum of the three colours'
/// steps from the pixel to the tap, 0 from 64 on. So taps on the pixel's own surface decide.
///
/// In each of kSweeps sweeps all pixels at once try, in this order, the planes that those kOffsets[sweep] pixels left, right,
/// above and below had before the sweep, continued to the pixel; then kRandom planes near the best of these, within half a
/// pixel and an eighth of a pixel per pixel at first, and half of that with every further sweep and try. A plane is taken where
/// its energy is less than that of the best so far. Planes that are outside 0 .. max_disparity - 1 at the pixel are not tried.
///
/// Shape    guide and planes H x W of the energies
/// Threads  rows are independent within a sweep: a sweep reads what the one before it left
/// Exact    ref and simd agree bit for bit, with any number of threads: integers, and random numbers that are a function of
///          pixel, sweep and try; an energy is at most 169 * 219 * 107 * 16 < 2^26
/// Source   Bleyer, Rhemann, Rother, "PatchMatch stereo: stereo matching with slanted support windows", 2011; slanted surfaces
///          as in Ogale, Aloimonos, "Shape and the stereo correspondence problem", 2005; weights as in Yoon, Kweon, "Adaptive
///          support-weight approach for correspondence search", 2006. All pixels at once instead of in turn, and energies with
///          the paths of semi-global matching instead of colours and gradients, are ours
struct SlantedPlanes {
  static constexpr int kRadius = 12, kStep = 2, kSweeps = 1, kRandom = 3;
  static constexpr std::array<int, kSweeps> kOffsets = {1};
  /// round(255 exp(-(4 i + 1.5) / 10)), at least 1.
  alignas(16) static constexpr std::array<std::uint8_t, 16> kWeights = {219, 147, 99, 66, 44, 30, 20, 13,
                                                                        9,   6,   4,  3,  2,  1,  1,  1};

  const EnergyVolume& energies;
  View<const Rgb8> guide;
};

/// What pixel (y, x) tries of the pixel at an offset from it.
inline Plane plane_of_neighbour(const PlaneMap& planes, int y, int x, int dy, int dx) {
  Plane plane = planes.at(y + dy, x + dx);
  plane.d = plane.at(-dy, -dx);
  return plane;
}
/// The weight of a tap whose colour is `b` beside a pixel whose colour is `a`.
inline int slanted_weight(Rgb8 a, Rgb8 b) {
  const int step = std::abs(a.r - b.r) + std::abs(a.g - b.g) + std::abs(a.b - b.b);
  return step < 64 ? SlantedPlanes::kWeights[static_cast<std::size_t>(step / 4)] : 0;
}
/// A plane near another one.
Plane plane_nearby(const Plane& plane, int y, int x, int sweep, int attempt);

namespace ref {
int plane_energy(const SlantedPlanes& in, int y, int x, const Plane& plane);
void slanted_planes(const SlantedPlanes& in, PlaneMap& planes);
}  // namespace ref

namespace simd {
/// The planes after a sweep, and the guide as planes of bytes with room around them.
struct SlantedPlanesScratch {
  explicit SlantedPlanesScratch(Size size);
  PlaneMap next;
  std::array<Image<std::uint8_t>, 3> guide;
  Image<std::uint8_t> outside;  // 255 outside the picture
};
void slanted_planes(Pool& pool, const SlantedPlanes& in, SlantedPlanesScratch& scratch, PlaneMap& planes);
}  // namespace simd

}  // namespace duo
