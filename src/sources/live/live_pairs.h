// Two live sources as one stream of pairs.
#pragma once

#include <memory>

#include "duoptic/source.h"

namespace duo {

/// Each source runs in a thread of its own; what comes is paired by its time of capture (pairing.h). While one is away next()
/// gives kNothing, and warning() says which.
///
/// Both must be live and of the same size.
///
/// Errors  the system gives no thread
Result<std::unique_ptr<PairSource>> make_live_pairs(std::unique_ptr<Source> left, std::unique_ptr<Source> right);

}  // namespace duo
