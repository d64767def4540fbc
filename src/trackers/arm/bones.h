// How well the frame supports a bone, and the elbows that both bone lengths allow.
#pragma once

#include <optional>

#include "trackers/arm/chain.h"
#include "trackers/arm/silhouette.h"

namespace duo::arm {

/// A stretch of a bone from `a` to `b`, as shares of the way, looked at in `samples` places.
struct Bone {
  Vec3 a, b;
  double radius_m = 0, from = 0, to = 1;
  int samples = 5;
};

/// Between about -3 (the background shines through) and 1 (all of it is there at the right depth, and no wider than a limb).
double bone_evidence(const Grid& grid, const Silhouette& silhouette, const Bone& bone, double disparity_sigma_px);

struct JointPrior {
  Vec3 p;
  double sigma_m = 0;
};

struct ElbowSeen {
  Vec3 p;            // mean of the hypotheses by their likelihood
  double score = 0;  // log likelihood of the best, up to 6
  double spread_m = 0;
};

/// The circle of elbows at `upper_m` from the shoulder and `fore_m` from the hand; lengths that cannot meet are stretched.
struct ElbowCircle {
  Vec3 centre, e1, e2;
  double radius_m = 0;
  double stretch_m = 0;  // how far the lengths fail to meet

  ElbowCircle(Vec3 shoulder, Vec3 hand, const Lengths& lengths);
  Vec3 at(double angle_rad) const;
};

/// Directions in rings `ring_rad` apart around one.
struct Cap {
  double ring_rad;
  int rings;
};

class ElbowFinder {
 public:
  ElbowFinder(const Grid& grid, const Silhouette& silhouette, const Lengths& lengths, const Params& params)
      : grid_(grid), silhouette_(silhouette), lengths_(lengths), params_(params) {}
  /// On the circle between shoulder and hand; `back` is away from where the torso looks.
  ElbowSeen between(Vec3 shoulder, Vec3 hand, const JointPrior& prior, Vec3 back) const;
  /// Without a hand: within 45 degrees of the predicted direction.
  ElbowSeen near(Vec3 shoulder, const JointPrior& prior) const;
  /// Likewise, in any direction but close to the opposite one.
  ElbowSeen anywhere(Vec3 shoulder, const JointPrior& prior) const;
  /// Where what is seen of the forearm leads an unseen hand; none where that is inside the picture.
  std::optional<Vec3> hand_outside(Vec3 elbow, const JointPrior& prior) const;

 private:
  ElbowSeen in_directions(Vec3 shoulder, const JointPrior& prior, Cap cap) const;
  double upper(Vec3 shoulder, Vec3 elbow, int samples) const;
  double fore(Vec3 elbow, Vec3 hand) const;
  const Grid& grid_;
  const Silhouette& silhouette_;
  const Lengths& lengths_;
  const Params& params_;
};

}  // namespace duo::arm
