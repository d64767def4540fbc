// Puts joints where their colour and their points say that they are.
#pragma once

#include <span>

#include "trackers/thesis/observation.h"

namespace duo {

constexpr int kLeastBlobPixels = 12, kLeastVotes = 3;

/// What speaks for one joint.
///
/// Shape   matches and to_joint: one a stored point
struct JointEvidence {
  PlaceQ4 expected;
  const AreaSums* color = nullptr;  // of its region; kLeastBlobPixels of it are one
  const SiftPoints* seen = nullptr;
  std::span<const PointMatch> matches;
  std::span<const PlaceQ4> to_joint;
};

// The colour's opinion is its region's mean place, rounded; the points' is the median, at n / 2 of n in order and for x and y
// alone, of the places that at least kLeastVotes matched points give: the seen point, rounded, and the way from the stored one.
// With both opinions half way between, rounded down. The disparity is that of the nearest pixel, kNone outside the picture.
//
// Units    1/16 px; seen points within 2^15 px
// Threads  joints are independent
// Exact    ref and vk agree bit for bit
// Source   the thesis: blob and SIFT in parallel, their average, depth read back there; the median is ours
namespace ref {
ObservedJoint place_joint(const JointEvidence& in, View<const std::uint16_t> d_q4);
}

}  // namespace duo
