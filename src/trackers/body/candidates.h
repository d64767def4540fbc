// Where a joint may be, and how likely it is there.
#pragma once

#include <algorithm>
#include <span>

#include "trackers/body/scene.h"

namespace duo::body {

// Scores are log likelihoods, up to a constant.
constexpr double kDepthSigma_px = 0.35;
constexpr double kSameSurface = -6;  // on what another limb, or somebody else, stands on
constexpr double kMostExpectedRoot = 12, kMostExpected = 4,
                 kMostExpectedEnd = 3;                                 // by which the place expected may count against
constexpr double kBackSigma_m = 0.06;                                  // of a hidden hand on the back, one standard deviation
constexpr double kHangingSigma_m = 0.09, kHangingElbowSigma_m = 0.06;  // of an arm that the trunk hides from the side

struct Candidate {
  Vec3 p;
  double score = 0;
  double skin_z_m = 0;    // of its surface; 0: hidden
  bool doubtful = false;  // its surface may be the trunk's

  bool hidden() const { return skin_z_m == 0; }
};

struct Candidates {
  std::array<Candidate, 24> all = {};
  std::size_t count = 0;
  void add(const Candidate& candidate) {
    if (count < all.size()) all[count++] = candidate;
  }
  std::span<const Candidate> get() const { return {all.data(), count}; }
};

inline double capped(double distance, double sigma, double most) { return -std::min(square(distance / sigma) / 2, most); }

/// Of a bone between two places.
double length_score(const Scene& scene, Bone bone, Vec3 a, Vec3 b);

/// A place on the ray of the joint's point.
Vec3 on_ray(const Scene& scene, JointId id, double z);

/// One standard deviation of the depth of a place on a surface.
double z_sigma_m(const Scene& scene, double z);

/// A candidate on each surface at the joint's point; of the trunk's own, only where nothing is before it.
void add_surfaces(const Scene& scene, JointId id, double most_expected, Candidates& out);
/// A hidden place.
void add_hidden(const Scene& scene, JointId id, Vec3 p, double most_expected, Candidates& out);
/// Hidden places on the joint's ray that lie a bone's length from another joint.
void add_sphere(const Scene& scene, JointId id, Vec3 other, double length, double most_expected, Candidates& out);

}  // namespace duo::body
