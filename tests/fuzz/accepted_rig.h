// What must hold of every rig that a reader accepts, whatever bytes it came from.
#pragma once

#include "calib/rectification.h"
#include "calib/rig_formats.h"
#include "core/check.h"

namespace duo::fuzz {

/// It survives being written and read again, and can be rectified or is refused for a reason.
inline void check_accepted(const Rig& rig) {
  const auto again = parse_rig(json_from_rig(rig), "again");
  DUO_CHECK(again && again->left == rig.left && again->right == rig.right && again->right_from_left == rig.right_from_left);

  const auto geometry = rectified_geometry(rig, "fuzz");
  if (!geometry) return;
  DUO_CHECK(!geometry->size.empty() && geometry->focal_px > 0 && geometry->baseline_m > 0);
  DUO_CHECK(geometry->size.width <= 1.5 * rig.left.size.width + 2 && geometry->size.height <= 1.5 * rig.left.size.height + 2);
}

}  // namespace duo::fuzz
