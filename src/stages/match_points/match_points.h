// Finds stored points again among the points of a new picture.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/pool.h"
#include "stages/types/sift_points.h"

namespace duo {

struct MatchPointsParams {
  int ratio_percent = 80;  // the nearest must be closer than this share of the second nearest
  bool mutual = true;      // and the stored point must be the nearest to it
  float reach_px = 64;     // from the predicted place, where one is given
};

struct PredictedPlace {
  float x_px = 0, y_px = 0;
};

// matches[i] tells which seen point is stored point i.
//
// Candidates of i are the seen points within reach_px (Euclidean, the border belongs to it) of predicted[i], or all when
// `predicted` is empty. The nearest by the distance of descriptors wins, the lowest index at equal distance, if its distance is
// less than ratio_percent of that of the next candidate, if any; and, when `mutual`, if no other stored point that has it
// as candidate is nearer to it, or as near with a lower index.
//
// Shape    predicted empty or stored.count; matches stored.count
// Units    square_distance of u8 descriptors: at most 128 * 255^2 < 2^23
// Threads  stored points are independent
// Exact    ref, simd and vk agree bit for bit
// Source   Lowe, "Distinctive image features from scale-invariant keypoints", 2004, section 7.1 (ratio)
namespace ref {
void match_points(const SiftPoints& stored, std::span<const PredictedPlace> predicted, const SiftPoints& seen,
                  const MatchPointsParams& params, std::span<PointMatch> matches);
}
namespace simd {
void match_points(Pool& pool, const SiftPoints& stored, std::span<const PredictedPlace> predicted, const SiftPoints& seen,
                  const MatchPointsParams& params, std::span<PointMatch> matches);
}

}  // namespace duo
