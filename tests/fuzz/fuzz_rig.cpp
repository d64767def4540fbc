// Any bytes as a rig file: no crash, and what is accepted can be rectified and survives being written and read again.
#include <cstdint>
#include <string_view>

#include "calib/rectification.h"
#include "calib/rig_formats.h"
#include "core/check.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto rig = duo::parse_rig({reinterpret_cast<const char*>(data), size}, "fuzz");
  if (!rig) return 0;
  const auto again = duo::parse_rig(duo::json_from_rig(*rig), "again");
  DUO_CHECK(again && again->left == rig->left && again->right == rig->right && again->right_from_left == rig->right_from_left);

  const auto geometry = duo::rectified_geometry(*rig, "fuzz");
  if (!geometry) return 0;
  DUO_CHECK(!geometry->size.empty() && geometry->focal_px > 0 && geometry->baseline_m > 0);
  DUO_CHECK(geometry->size.width <= 1.5 * rig->left.size.width + 2 && geometry->size.height <= 1.5 * rig->left.size.height + 2);
  return 0;
}
