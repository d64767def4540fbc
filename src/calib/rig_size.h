// Pictures of another size than their rig's.
#pragma once

#include <string>

#include "duoptic/rig.h"

namespace duo {

/// Why pictures of this size are not the rig's, in one line with what to do: of another shape, scaled, or on their side. Empty:
/// they have its size.
std::string why_other_size(const Rig& rig, Size pictures);

}  // namespace duo
