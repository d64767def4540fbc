// The synthetic person as a live source.
#pragma once

#include <memory>
#include <string_view>

#include "duoptic/source.h"

namespace duo {

/// "synthetic", "synthetic:SCRIPT", "synthetic:SCRIPT:WIDTHxHEIGHT" or "synthetic:SCRIPT:WIDTHxHEIGHT:PAIRS".
bool is_synthetic_name(std::string_view name);

/// Renders the first PAIRS, 60 when not given, of a clip in a thread of its own, then gives them as two cameras would, 30 pairs
/// a second, to their end, backwards to their start, and again. Until they are rendered next() gives kNothing and warning()
/// tells how far it is.
///
/// Errors  the name is none of the above; those of SyntheticClip::open()
Result<std::unique_ptr<PairSource>> open_live_clip(std::string_view name);

}  // namespace duo
