// How near a frame of the synthetic room comes to its exact truth.
#pragma once

#include "duoptic/frame.h"
#include "duoptic/synthetic.h"

namespace duo::app {

struct Accuracy {
  double bad_percent = 0;          // more than 1 px off, of the pixels with a disparity
  double coverage_percent = 0;     // pixels with a disparity, of those that both cameras see
  double depth_error_percent = 0;  // median of |z - truth| / truth
};

/// Of the ideal pair: every pixel that both cameras see.
Accuracy ideal_accuracy(const Frame& frame, const SyntheticPair& ideal);

/// Of the raw pair: each point found is carried back through rectification and lens into the raw left picture and compared
/// with the truth there; coverage is of the pixels that both raw pictures cover.
Accuracy raw_accuracy(const Frame& frame, const Rectified& rectified, const SyntheticPair& raw);

}  // namespace duo::app
