// How far the trunk's surface lies before the plane of shoulders and hips: what tells an arm before the trunk from the trunk.
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "trackers/body/joints.h"
#include "trackers/body/lift.h"

namespace duo::body {

/// The trunk's own axes: across from right to left, down the spine, and to where the chest looks.
struct TrunkAxes {
  Vec3 shoulders;  // their middle
  Vec3 across, down, front;
  double width_m = 0, length_m = 0;

  /// Along the three axes, metres from the shoulders' middle.
  Vec3 of(Vec3 p) const {
    const Vec3 q = p - shoulders;
    return {dot(q, across), dot(q, down), dot(q, front)};
  }
  /// Back again.
  Vec3 in_rig(Vec3 in_trunk) const { return shoulders + in_trunk.x * across + in_trunk.y * down + in_trunk.z * front; }
};
TrunkAxes trunk_axes(const Places& joints);

/// How far chest and back of an adult lie from the plane, `down_m` below the shoulders.
double default_height_m(const TrunkAxes& axes, double down_m, double width_m);

/// One map for the chest and one for the back. Cells in shares of the trunk's width and length, so that they go along with it.
class SurfaceMap {
 public:
  /// Height of the trunk's surface at a point before or behind the plane, on the side that the cameras see; none beside the
  /// trunk.
  std::optional<double> height_m(const TrunkAxes& axes, Vec3 p, double width_m) const;
  /// Takes in what lies at least 11 cm away from the arms. `ticks`: since the last time.
  void learn(const DepthView& depth, const TrunkAxes& axes, const Places& joints, double ticks);

 private:
  static constexpr int kColumns = 14, kRows = 14;
  struct Cell {
    float height_m = 0;
    std::uint8_t count = 0;
  };
  static std::optional<std::size_t> cell_of(const TrunkAxes& axes, Vec3 in_trunk);
  std::array<std::array<Cell, static_cast<std::size_t>(kColumns* kRows)>, 2> sides_ = {};
};

}  // namespace duo::body
