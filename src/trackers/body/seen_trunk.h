// The trunk of a body that the networks found, in the picture.
#pragma once

#include <array>

#include "trackers/body/frame_view.h"
#include "trackers/body/scene.h"

namespace duo::body {

/// Left and right shoulder, left and right hip.
///
/// Units  px
using TrunkCorners = std::array<Vec2, 4>;
TrunkCorners corners_of(const SeenBody& seen);
Vec2 centre_of(const TrunkCorners& corners);

/// Where shoulders and hips, in the order of TrunkCorners, are in the picture.
TrunkCorners corners_at(const std::array<Vec3, 4>& corners, const Rectified& camera);
/// Where a scene expects them.
TrunkCorners expected_corners(const Scene& scene);

/// Whether the network took left for right: the corners are much nearer to where the other side's are expected. Never where
/// the trunk is expected nearly from the side, where both sides lie together.
bool are_sides_exchanged(const TrunkCorners& seen, const TrunkCorners& expected);
/// Left for right, in the picture and in space.
SeenBody with_sides_exchanged(const SeenBody& seen);

/// Mean colour: shares of red and green, and how bright.
struct TrunkColor {
  double red = 1.0 / 3, green = 1.0 / 3, bright = 0;
  bool known = false;

  /// Follows what is seen now, slowly. `ticks`: since the last time.
  void learn(const TrunkColor& now, double ticks);
};

/// Of what nobody covers; unknown where that is little.
TrunkColor color_of(const FrameView& frame, const TrunkCorners& corners);

/// Share of the trunk that somebody nearer covers.
double covered_share(const FrameView& frame, const TrunkCorners& corners);

}  // namespace duo::body
