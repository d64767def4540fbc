// The synthetic person as a live source.
#pragma once

#include <memory>
#include <string_view>

#include "duoptic/source.h"

namespace duo {

/// "synthetic", "synthetic:SCRIPT", "synthetic:SCRIPT:WIDTHxHEIGHT" or "synthetic:SCRIPT:WIDTHxHEIGHT:PAIRS".
bool is_synthetic_name(std::string_view name);

/// Renders the first PAIRS, 60 when not given, of a clip in a thread of its own, and gives them as two cameras would, 30 pairs
/// a second, to their end, backwards to their start, and again. The first time each is given when it is rendered, slower than
/// that, and warning() tells how far it is; then they are kept in the user's cache, for later starts of the same build.
///
/// Errors  the name is none of the above; those of SyntheticClip::open()
Result<std::unique_ptr<PairSource>> open_live_clip(std::string_view name);

}  // namespace duo
