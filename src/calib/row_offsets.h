// The fit behind find_row_offsets(), and what an engine makes of it.
#pragma once

#include "calib/rectification.h"
#include "calib/scene_matches.h"
#include "duoptic/row_offsets.h"

namespace duo {

RowOffsets fit_row_offsets(const SceneMatches& scene);
/// Rows of points that differ by no more than this from those of the most are put right; others are taken for wrong matches.
double row_reach_px(int height);

/// Maps that leave the left picture where it is and take the offsets off the right one; no geometry. Rows up to one pixel
/// beyond the right picture are its last ones.
Rectification row_maps(const RowOffsets& rows);

}  // namespace duo
