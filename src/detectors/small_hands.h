// A choice of networks that the public options do not offer.
#pragma once

#include <memory>

#include "duoptic/detector.h"

namespace duo {

/// As make_detector(), but hands by the smaller network whatever the body's: half the time, and as good on hands that are
/// followed.
Result<std::unique_ptr<Detector>> make_detector_with_small_hands(const DetectorOptions& options);

}  // namespace duo
