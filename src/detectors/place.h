// Between the pixels of a crop and those of its picture.
#pragma once

#include <cstdint>

#include "duoptic/detector.h"

namespace duo {

struct PointQ8 {
  std::int32_t x = 0, y = 0;
};

/// A region is so much larger than the circle around its person.
inline constexpr int kRegionMargin = 5, kRegionMarginOf = 4;

/// Where a point of a crop lies in the picture. u, v in 1/256 px of the crop, from its left and upper edge; side: px of the
/// crop.
PointQ8 placed(const TurnedSquare& region, PointQ8 in_crop, int side);

/// A length in a crop as one in the picture, both in 1/256 px.
std::int32_t placed_length(const TurnedSquare& region, std::int32_t length, int side);

/// The square around the circle about `center` through `top`, a quarter larger; upright when `top` is above.
TurnedSquare region_around(PointQ8 center, PointQ8 top);

/// Half the side of a region, in 1/256 px.
std::int32_t half_side(const TurnedSquare& region);

/// Whether a region is one to look at: at least 8 px wide, no more than four pictures, its centre near the picture, all of it
/// within 32768 px of the picture's corner.
bool usable(const TurnedSquare& region, Size picture);

}  // namespace duo
