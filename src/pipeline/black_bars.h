// Black bars that both pictures have.
#pragma once

#include <string>

#include "duoptic/frame.h"

namespace duo {

/// Above and below, or at both sides, alike in both pictures, with straight borders, as when pictures of one shape are put into
/// another: one line; else empty. A matcher makes depth up in them, and a rig of pictures without them does not fit.
std::string black_bars(const Pair& pair);

}  // namespace duo
