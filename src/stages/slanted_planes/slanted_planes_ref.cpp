#include "stages/slanted_planes/slanted_planes.h"

#include <algorithm>
#include <utility>

#include "core/check.h"

namespace duo {
namespace {

/// Source  "lowbias32" of Wellons' search for integer hash functions, 2018
std::uint32_t mixed(std::uint32_t v) {
  v = (v ^ v >> 16) * 0x7FEB352DU;
  v = (v ^ v >> 15) * 0x846CA68BU;
  return v ^ v >> 16;
}

/// The low 16 bits as a number of -most .. most.
int spread(std::uint32_t random, int most) { return (static_cast<int>(random & 0xFFFF) - 0x8000) * most >> 15; }

}  // namespace

Plane plane_nearby(const Plane& plane, int y, int x, int sweep, int attempt) {
  constexpr int kFar = Plane::kOne / 2, kSteep = Plane::kOne / 8;
  const auto part = [](int v) { return static_cast<std::uint32_t>(v); };
  const std::uint32_t seed = ((part(y) * 4096 + part(x)) * 8 + part(attempt)) * 8 + part(sweep);
  const std::uint32_t first = mixed(seed), second = mixed(first + 0x9E3779B9U);
  const auto slope = [&](int old, std::uint32_t random) {
    return std::clamp(old + spread(random, kSteep >> (sweep + attempt)), -Plane::kSteepest, Plane::kSteepest);
  };
  return {plane.d + spread(first, kFar >> (sweep + attempt)), slope(plane.dx, first >> 16), slope(plane.dy, second)};
}

namespace ref {
namespace {

using Slanted = SlantedPlanes;

/// Of one disparity in 1/4096 px, in sixteenths.
int energy_at(const EnergyVolume& energies, int y, int x, int d) {
  const int last = energies.max_disparity() - 1, held = std::clamp(d, 0, last << Plane::kBits);
  const int whole = held >> Plane::kBits, sixteenths = held >> (Plane::kBits - 4) & 15;
  const std::uint8_t* of_0 = energies.cell(y, x) + energies.lanes() - 1;
  return of_0[-whole] * (16 - sixteenths) + of_0[-std::min(whole + 1, last)] * sixteenths;
}

}  // namespace

int plane_energy(const Slanted& in, int y, int x, const Plane& plane) {
  int sum = 0;
  for (int ty = y - Slanted::kRadius; ty <= y + Slanted::kRadius; ty += Slanted::kStep)
    for (int tx = x - Slanted::kRadius; tx <= x + Slanted::kRadius; tx += Slanted::kStep) {
      if (ty < 0 || ty >= in.guide.height() || tx < 0 || tx >= in.guide.width()) continue;
      sum += slanted_weight(in.guide.at(y, x), in.guide.at(ty, tx)) * energy_at(in.energies, ty, tx, plane.at(ty - y, tx - x));
    }
  return sum;
}

namespace {

Plane settled(const Slanted& in, const PlaneMap& before, int y, int x, int sweep) {
  Plane best = before.at(y, x);
  int least = plane_energy(in, y, x, best);
  const auto attempt = [&](const Plane& plane) {
    if (plane.d < 0 || plane.d > (in.energies.max_disparity() - 1) << Plane::kBits) return;
    const int sum = plane_energy(in, y, x, plane);
    if (sum < least) least = sum, best = plane;
  };
  const int offset = Slanted::kOffsets[static_cast<std::size_t>(sweep)];
  for (const auto& [dy, dx] : {std::pair{0, -offset}, {0, offset}, {-offset, 0}, {offset, 0}}) {
    if (y + dy < 0 || y + dy >= in.guide.height() || x + dx < 0 || x + dx >= in.guide.width()) continue;
    attempt(plane_of_neighbour(before, y, x, dy, dx));
  }
  for (int k = 0; k < Slanted::kRandom; ++k) attempt(plane_nearby(best, y, x, sweep, k));
  return best;
}

}  // namespace

void slanted_planes(const SlantedPlanes& in, PlaneMap& planes) {
  DUO_CHECK(in.guide.size() == in.energies.size() && planes.size() == in.guide.size());
  PlaneMap next(planes.size());
  for (int sweep = 0; sweep < Slanted::kSweeps; ++sweep) {
    for (int y = 0; y < in.guide.height(); ++y)
      for (int x = 0; x < in.guide.width(); ++x) next.set(y, x, settled(in, planes, y, x, sweep));
    std::swap(planes, next);
  }
}

}  // namespace ref
}  // namespace duo
