// Coordinate systems by name: those of other programs.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

#include "duoptic/geometry.h"
#include "duoptic/result.h"

namespace [[gnu::visibility("default")]] duo {

/// All have their origin in the left camera's centre and count metres. "Up" is the left camera's, after rectification.
enum class Axes : std::uint8_t {
  kOpencv,   // x right, y down, z forward: the rig frame
  kRos,      // x forward, y left, z up (REP 103)
  kOpengl,   // x right, y up, z backward
  kUnity,    // x right, y up, z forward: left-handed
  kBlender,  // x right, y forward, z up: where Blender puts a BVH file
};
inline constexpr std::array<std::string_view, 5> kAxesNames = {"opencv", "ros", "opengl", "unity", "blender"};

/// p = axes_from_rig(axes) * p_in_rig. Rows are unit vectors; the determinant is 1, of left-handed axes -1.
const Mat3& axes_from_rig(Axes axes);

/// Errors  unknown name, with the known ones
Result<Axes> axes_of(std::string_view name);

}  // namespace duo
