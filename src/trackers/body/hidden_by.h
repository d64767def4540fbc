// What stands before a person, a chair or a table, and hides a part of it.
#pragma once

#include "trackers/body/scene.h"

namespace duo::body {

/// Marks surfaces that are of something before the person. Its skin is followed from the chest along each limb; where something
/// begins that is nearer by 10 cm and half a pixel of disparity, the joints there are hidden. Of arms only what is wider than
/// 33 cm hides, as they are held before the body; a knee that is lifted straight at the cameras counts as hidden.
void mark_what_hides(Scene& scene);

}  // namespace duo::body
