// The points of a frame, seen from anywhere.
#pragma once

#include <optional>

#include "duoptic/frame.h"
#include "duoptic/rig.h"

namespace duo::app::view {

/// A camera on a sphere around a point that it looks at.
///
/// Units  rig frame; yaw to the right, pitch up; zoom 1: as large as the rig's own camera sees it
struct Orbit {
  double yaw_rad = -0.3, pitch_rad = 0.2, zoom = 1;
  double middle_m = 2;  // of what is looked at, straight ahead of the rig
};

/// Where a point is in a picture of the orbit's camera.
struct OnScreen {
  double x_px = 0, y_px = 0, z_m = 0;
};

/// The orbit's camera for a picture of some size.
class OrbitCamera {
 public:
  OrbitCamera(const Orbit& orbit, const Rectified& rectified, Size size);
  /// None behind the camera.
  std::optional<OnScreen> place(Vec3 p_in_rig_m) const;

 private:
  friend void draw_points(View<const std::uint16_t> d_q4, View<const Rgb8> color, const Rectified& rectified,
                          const OrbitCamera& camera, View<Rgb8> dst);
  Mat3 turn_;
  Vec3 middle_in_rig_m_;
  double distance_m_, focal_px_, cx_px_, cy_px_;
};

/// The depth that a quarter of the points is nearer than, metres; 0 without any.
double foreground_m(View<const std::uint16_t> d_q4, const Rectified& rectified);

/// Each point as a square as large as its pixel, what is nearest in front.
///
/// Shape  d_q4 and color H x W of the frame, dst of any size
void draw_points(View<const std::uint16_t> d_q4, View<const Rgb8> color, const Rectified& rectified, const OrbitCamera& camera,
                 View<Rgb8> dst);

}  // namespace duo::app::view
