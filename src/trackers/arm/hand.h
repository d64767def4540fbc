// Where the hand is in a region: its far end, seen from the elbow.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "trackers/arm/chain.h"
#include "trackers/arm/silhouette.h"

namespace duo::arm {

/// A ball that the hand must lie in.
struct Gate {
  Vec3 centre;
  double radius_m = 0;
};

struct HandSeen {
  Vec3 p;                                         // the hand's centre, inside it
  double tip_m = 0;                               // from the elbow to the fingertips
  double area_m2 = 0, solid_m2 = 0, skin_m2 = 0;  // of the region's last hand_length
  double cut = 0;                                 // share of the places just beyond the fingertips that no camera shows
};

class HandFinder {
 public:
  HandFinder() = default;
  explicit HandFinder(const Grid& grid);

  /// `centre_m`: from the fingertips back to the hand's centre, of this hand. None where the region ends in nothing like a
  /// hand.
  std::optional<HandSeen> find(const Grid& grid, const Silhouette& silhouette, std::span<const int> cells, Vec3 elbow,
                               double fore_m, double centre_m, const Gate* gate, const Params& params);

 private:
  struct Far {
    double distance_m;
    Vec3 p;
    int cell;
  };
  double collect(const Grid& grid, std::span<const int> cells, Vec3 elbow, double fore_m, const Gate* gate);
  double distance_within(double share);
  double along(double tip_m, double centre_m, double palm_m);
  double median_of_depths();
  Vec3 centre(Vec3 elbow, Vec3 start, double along_m, double z_m);

  std::vector<Far> far_;
  std::vector<double> depths_m_;
};

/// Share of the places just beyond the fingertips where something nearer stands: there the arm goes on behind it, and what
/// looks like a hand is the forearm.
double covered_beyond(const Grid& grid, const std::vector<std::uint8_t>& front, Vec3 elbow, const HandSeen& hand,
                      const Params& params);

}  // namespace duo::arm
