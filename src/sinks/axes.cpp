#include "duoptic/axes.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace duo {

const Mat3& axes_from_rig(Axes axes) {
  constexpr Vec3 kX{1, 0, 0}, kLeft{-1, 0, 0}, kUp{0, -1, 0}, kDown{0, 1, 0}, kForward{0, 0, 1}, kBack{0, 0, -1};
  static const std::array<Mat3, kAxesNames.size()> kTable = {
      Mat3::from_rows(kX, kDown, kForward),   // opencv
      Mat3::from_rows(kForward, kLeft, kUp),  // ros
      Mat3::from_rows(kX, kUp, kBack),        // opengl
      Mat3::from_rows(kX, kUp, kForward),     // unity
      Mat3::from_rows(kX, kForward, kUp),     // blender
  };
  return kTable[static_cast<std::size_t>(axes)];
}

Result<Axes> axes_of(std::string_view name) {
  for (std::size_t i = 0; i < kAxesNames.size(); ++i)
    if (kAxesNames[i] == name) return static_cast<Axes>(i);
  return Error{ErrorCode::kBadInput, fmt::format("no axes '{}'; there are: {}", name, fmt::join(kAxesNames, ", "))};
}

}  // namespace duo
