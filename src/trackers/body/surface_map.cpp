#include "trackers/body/surface_map.h"

#include <algorithm>
#include <cmath>

namespace duo::body {
namespace {

// The map covers so much of the trunk's width to each side, and of its length from a little above the shoulders to below the
// hips.
constexpr double kHalfWidths = 0.75, kAbove = 0.1, kBelow = 1.25;

bool seen_from_front(const TrunkAxes& axes) { return dot(axes.front, axes.shoulders) < 0; }

}  // namespace

TrunkAxes trunk_axes(const Places& joints) {
  using enum JointId;
  TrunkAxes out;
  out.shoulders = middle(joints[kLeftShoulder], joints[kRightShoulder]);
  const Vec3 hips = middle(joints[kLeftHip], joints[kRightHip]);
  const Vec3 across = joints[kLeftShoulder] - joints[kRightShoulder];
  out.width_m = std::max(norm(across), 0.05);
  out.length_m = std::max(distance(out.shoulders, hips), 0.1);
  out.down = (1 / out.length_m) * (hips - out.shoulders);
  const Vec3 level = across - dot(across, out.down) * out.down;
  out.across = (1 / std::max(norm(level), 1e-6)) * level;
  out.front = cross(out.across, out.down);  // of a person who faces the camera: across +x, down +y, so +z is the back
  out.front = -1.0 * out.front;
  return out;
}

double default_height_m(const TrunkAxes& axes, double down_m, double width_m) {
  constexpr double kShoulderDepth = 0.185, kHipDepth = 0.36;  // of the shoulders' width
  const double t = std::clamp(down_m / axes.length_m, 0.0, 1.0);
  return width_m * (kShoulderDepth + t * (kHipDepth - kShoulderDepth));
}

std::optional<std::size_t> SurfaceMap::cell_of(const TrunkAxes& axes, Vec3 in_trunk) {
  const double u = (in_trunk.x / axes.width_m + kHalfWidths) / (2 * kHalfWidths);
  const double v = (in_trunk.y / axes.length_m + kAbove) / (kAbove + kBelow);
  if (!(u >= 0 && u < 1 && v >= 0 && v < 1)) return std::nullopt;
  return static_cast<std::size_t>(static_cast<int>(v * kRows) * kColumns + static_cast<int>(u * kColumns));
}

std::optional<double> SurfaceMap::height_m(const TrunkAxes& axes, Vec3 p, double width_m) const {
  constexpr int kEnough = 3;
  const Vec3 q = axes.of(p);
  const auto cell = cell_of(axes, q);
  if (!cell) return std::nullopt;
  const bool front = seen_from_front(axes);
  const Cell& found = sides_[front ? 0 : 1][*cell];
  if (found.count >= kEnough) return found.height_m;
  if (std::abs(q.x) > 0.5 * axes.width_m) return std::nullopt;
  const double height = default_height_m(axes, q.y, width_m);
  return front ? height : -height;
}

void SurfaceMap::learn(const DepthView& depth, const TrunkAxes& axes, const Places& joints, double ticks) {
  constexpr double kArm_m = 0.11, kMost_m = 0.22, kGain = 0.2;  // per tick
  const double least_gain = gain_over(ticks, kGain);
  const Rectified& geometry = *depth.geometry;
  auto& cells = sides_[seen_from_front(axes) ? 0 : 1];
  for (int row = 0; row < kRows; ++row)
    for (int column = 0; column < kColumns; ++column) {
      const double x = ((column + 0.5) / kColumns * 2 - 1) * kHalfWidths * axes.width_m;
      const double y = ((row + 0.5) / kRows * (kAbove + kBelow) - kAbove) * axes.length_m;
      const Vec3 on_plane = axes.shoulders + x * axes.across + y * axes.down;
      if (!(on_plane.z > 0.1)) continue;
      const Vec2 at = geometry.project(on_plane);
      if (!(at.x >= 0 && at.y >= 0 && at.x <= depth.d_q4.width() - 1 && at.y <= depth.d_q4.height() - 1)) continue;
      const int px = static_cast<int>(at.x + 0.5), py = static_cast<int>(at.y + 0.5);
      const std::uint16_t q4 = depth.d_q4.at(py, px);
      if (q4 == Disparity::kNone || q4 == 0) continue;
      const Vec3 p = geometry.unproject({double(px), double(py)}, depth.z_m(q4));
      const Vec3 q = axes.of(p);
      if (std::abs(q.z) > kMost_m) continue;
      const bool on_arm = std::any_of(kArmChains.begin(), kArmChains.end(), [&](const Limb& arm) {
        return to_segment(p, joints[arm[1]], joints[arm[2]]) < kArm_m ||
               to_segment(p, joints[arm[2]], joints[arm[3]]) < kArm_m ||
               to_segment(p, middle(joints[arm[0]], joints[arm[1]]), joints[arm[1]]) < kArm_m;
      });
      if (on_arm) continue;
      const auto at_cell = cell_of(axes, q);
      if (!at_cell) continue;
      Cell& cell = cells[*at_cell];
      const double gain = std::max(least_gain, 1.0 / (cell.count + 1));
      cell.height_m += static_cast<float>(gain * (q.z - cell.height_m));
      cell.count = static_cast<std::uint8_t>(std::min(cell.count + 1, 200));
    }
}

}  // namespace duo::body
