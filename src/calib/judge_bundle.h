// What a bundle's rig is worth: errors, errors on views it has not seen, uncertainty.
#pragma once

#include <vector>

#include "calib/bundle.h"

namespace duo {

/// The rig of a bundle, with its errors and uncertainty but without those of held-out views.
Rig rig_of(const std::vector<const BoardView*>& views, const Board& board, const Bundle& bundle);

struct HeldOut {
  double reprojection_px = 0, row_px = 0, shape_m = 0, z_m = 0;
};

/// Every fourth view in turn is left out, the rest calibrated, and the boards left out measured with that rig.
HeldOut judge_held_out(const std::vector<const BoardView*>& views, const Board& board, const Bundle& bundle);

}  // namespace duo
