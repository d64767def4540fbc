#include "calib/rig_size.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <cstdlib>

namespace duo {

std::string why_other_size(const Rig& rig, Size pictures) {
  const Size of_rig = rig.left.size == pictures ? rig.right.size : rig.left.size;
  if (pictures == of_rig) return {};
  const std::int64_t across = std::int64_t{pictures.width} * of_rig.height, down = std::int64_t{pictures.height} * of_rig.width;
  std::string how =
      "of another shape, so they were cropped or stretched: calibrate with pictures of this size, or take them "
      "at the rig's";
  if (std::abs(across - down) <= std::max(of_rig.width, of_rig.height))  // less than a pixel off
    how = fmt::format("the same scaled by {:.3g}: calibrate with pictures of this size, or give them at the rig's",
                      static_cast<double>(pictures.width) / of_rig.width);
  else if (pictures.width == of_rig.height && pictures.height == of_rig.width)
    how = "on their side: turn them by 90 degrees";
  return fmt::format("the rig is of pictures of {}x{}, these have {}x{}, {}", of_rig.width, of_rig.height, pictures.width,
                     pictures.height, how);
}

}  // namespace duo
