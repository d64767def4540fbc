// The arm as two bones.
#pragma once

#include <algorithm>

#include "duoptic/geometry.h"

namespace duo::arm {

struct Lengths {
  double upper_m = 0, fore_m = 0;
  double reach_m() const { return upper_m + fore_m; }
};

inline double distance_to_segment(Vec3 p, Vec3 a, Vec3 b) {
  const Vec3 d = b - a;
  const double t = std::clamp(dot(p - a, d) / std::max(dot(d, d), 1e-12), 0.0, 1.0);
  return norm(p - (a + t * d));
}

struct Chain {
  Vec3 hand, elbow, shoulder;

  Lengths lengths() const { return {norm(elbow - shoulder), norm(hand - elbow)}; }
  double distance(Vec3 p) const {
    return std::min(distance_to_segment(p, shoulder, elbow), distance_to_segment(p, elbow, hand));
  }
};

/// How far from the arm something must be to be no part of it.
struct Clearance {
  double hand_m, fore_m, upper_m;
  bool holds(const Chain& arm, Vec3 p) const {
    return norm(p - arm.hand) > hand_m && distance_to_segment(p, arm.elbow, arm.hand) > fore_m &&
           distance_to_segment(p, arm.shoulder, arm.elbow) > upper_m;
  }
};

}  // namespace duo::arm
