// Pictures that are stored turned or mirrored, put upright.
#pragma once

#include <array>
#include <cstdint>

#include "duoptic/frame.h"

namespace duo {

/// How a stored picture is to be shown, numbered as EXIF does: the sides at which its first row and first column are seen.
enum class Orientation : std::uint8_t {
  kTopLeft = 1,  // as stored
  kTopRight,
  kBottomRight,
  kBottomLeft,
  kLeftTop,
  kRightTop,  // turned by 90 degrees clockwise to be upright
  kRightBottom,
  kLeftBottom,
};

/// What EXIF's number means; as stored where it means nothing.
Orientation orientation_of_exif(unsigned value);
/// The nearest to a display matrix of MP4: 9 numbers of fixed point, of which 0, 1, 3 and 4 turn.
Orientation orientation_of_matrix(const std::array<std::int32_t, 9>& matrix);

Size upright(Size stored, Orientation orientation);
/// Puts `picture` upright; `memory` is used again where it has the size.
void put_upright(Image<Rgb8>& picture, Orientation orientation, Image<Rgb8>& memory);

}  // namespace duo
