// The rectified left camera at any scale.
#pragma once

#include "core/lens.h"
#include "duoptic/geometry.h"
#include "duoptic/rig.h"

namespace duo {

/// Units   pixels of its own scale; centres of pixels are whole numbers
struct Pinhole {
  double focal_px = 0, cx_px = 0, cy_px = 0, baseline_m = 0;

  static Pinhole of(const Rectified& r) { return {r.focal_px, r.cx_px, r.cy_px, r.baseline_m}; }

  /// The camera whose pixels are blocks of step x step of this one's.
  Pinhole coarser(int step) const {
    const Vec2 c = coarse({cx_px, cy_px}, step);
    return {focal_px / step, c.x, c.y, baseline_m};
  }
  static Vec2 coarse(Vec2 at_px, double step) { return {(at_px.x + 0.5) / step - 0.5, (at_px.y + 0.5) / step - 0.5}; }

  Vec2 project(Vec3 p) const { return {cx_px + focal_px * p.x / p.z, cy_px + focal_px * p.y / p.z}; }
  Vec3 point(Vec2 at_px, double z_m) const {
    return {(at_px.x - cx_px) / focal_px * z_m, (at_px.y - cy_px) / focal_px * z_m, z_m};
  }
  double disparity_px(double z_m) const { return focal_px * baseline_m / z_m; }
};

/// The point `depth_m` behind p on its viewing ray: from the skin to the joint.
inline Vec3 behind(Vec3 p, double depth_m) { return (1 + depth_m / norm(p)) * p; }

}  // namespace duo
