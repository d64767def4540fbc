// The channels of match_tiles as the vector kernel wants them: bytes, edges continued, outside pixels encoded.
#pragma once

#include "stages/match_tiles/match_tiles.h"

namespace duo::simd {

// Outside pixels are values no inside pixel can come near: inside, gray is 0 .. 127 and gradients are 65 .. 191, so each
// channel differs by at least 64 > truncation whether one side is outside or both, and no mask is needed in the kernel.
inline constexpr std::uint8_t kLeftOutsideGray = 191, kLeftOutsideSobel = 255;
inline constexpr std::uint8_t kRightOutsideGray = 255, kRightOutsideLow = 255, kRightOutsideHigh = 0;

/// Fills scratch.left, scratch.right and the intervals.
void make_channels(Pool& pool, const GrayPair& pair, int sobel_clip, MatchTilesScratch& scratch);

}  // namespace duo::simd
