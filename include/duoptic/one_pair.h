// One pair of pictures as a stream.
#pragma once

#include <memory>

#include "duoptic/source.h"

namespace [[gnu::visibility("default")]] duo {

/// Gives the pair once.
std::unique_ptr<PairSource> one_pair(Pair pair);

}  // namespace duo
