// Flesh and cloth: round limbs that flow into each other, and remember which point of the resting body each surface point is.
#pragma once

#include <limits>
#include <vector>

#include "duoptic/geometry.h"

namespace duo::synthetic {

/// All points within a radius of the segment (0, 0, 0) .. (0, length, 0) in its own frame; the radius grows evenly from
/// `from_m` to `to_m`, and is divided by `flat` along z. What lies beyond y = cut is cut off.
struct Lobe {
  Rigid3 blend_from_lobe = {};
  Rigid3 rest_from_lobe = {};  // the same bone of the resting body: textures are fixed to that
  double length_m = 0, from_m = 0, to_m = 0;
  double flat = 1;
  double soft_m = 0.02;  // how far its seam to the lobes before it is smoothed
  double cut_m = std::numeric_limits<double>::infinity();
};

/// The smooth union of lobes, in their order.
class Blend {
 public:
  /// `lobes` lie around the origin: half_extent() is symmetric.
  explicit Blend(std::vector<Lobe> lobes);

  /// The t > t_min at which the ray origin + t direction enters, or infinity.
  ///
  /// Exact  marched to within 2e-6 m
  double enter(Vec3 origin, Vec3 direction, double t_min) const;
  /// Whether the ray enters at 0 < t < 1, give or take some mm: enough for a shadow.
  bool blocks(Vec3 origin, Vec3 direction) const;
  Vec3 normal(Vec3 p) const;
  Vec3 half_extent() const { return half_m_; }
  /// Where a point of the surface lies on the resting body.
  Vec3 at_rest(Vec3 p) const;

 private:
  struct Placed {
    Lobe lobe;
    Mat3 lobe_from_blend;
    double slope = 0, across = 1;  // of the cone's side
    Vec3 start_m, way_m;           // its axis
    double radius_m = 0;           // of the capsule around it
    Vec3 centre_m;                 // of the ball around that
    double reach_m = 0;
    double margin_m = 0;  // farther away than that it changes nothing: this seam, or one of the lobes after it
    double distance(Vec3 p) const;
  };
  struct Near;  // the lobes that a ray can meet
  Near near(Vec3 origin, Vec3 direction, double t_min, double t_max) const;
  double distance(Vec3 p, const Near& near) const;

  std::vector<Placed> lobes_;
  Vec3 half_m_;
};

}  // namespace duo::synthetic
