// Black bars that both pictures have.
#pragma once

#include <optional>
#include <string>

#include "duoptic/frame.h"

namespace duo {

/// Above and below, or at both sides, alike in both pictures, with straight borders, as when pictures of one shape are put into
/// another: one line; else empty. None of a dark pair, which cannot tell. A matcher makes depth up in them.
std::optional<std::string> black_bars(const Pair& pair);

}  // namespace duo
