// How noisy a pair is, from the pictures alone.
#pragma once

#include <array>
#include <cstdint>

#include "core/pool.h"
#include "duoptic/image.h"
#include "stages/types/noise.h"

namespace duo {

/// The noise of the noisier picture, in 1/16 gray levels; 0 where it is no more than clean pictures have, see
/// stages/types/noise.h.
///
/// The difference 1 -2 1 / -2 4 -2 / 1 -2 1 vanishes where a picture is linear along its rows or its columns. Its amounts are
/// summed over blocks of 8x8 pixels, corners at x = 1, 9, 17 ... and y = 1, 17, 33 ...; the sums are sorted into bins of 16. A
/// picture's level is the bin of the first block that has a twentieth of all at or below it: smooth surfaces show noise alone.
/// Blocks with a pixel of 0 or 255 do not count: they are outside the raw picture, or saturated.
///
/// Shape    both H x W; pictures smaller than 10x10 have no blocks and no noise
/// Exact    ref, simd and vk agree: integers
/// Source   Immerkaer, "Fast noise variance estimation", 1996 (the difference); blocks of little variation, as texture looks
///          like noise: Olsen, "Estimation of noise in images: an evaluation", 1993
namespace ref {
int noise_q4(View<const std::uint8_t> left, View<const std::uint8_t> right);
}
namespace simd {
int noise_q4(Pool& pool, View<const std::uint8_t> left, View<const std::uint8_t> right);
}

/// How many blocks of a picture have a sum in each bin.
using NoiseBins = std::array<int, kNoiseBins>;
/// The level of one picture.
int noise_level_q4(const NoiseBins& bins);

/// Blocks along `length` pixels, one each `step`.
constexpr int noise_blocks(int length, int step) {
  return length < kNoiseBlock + 2 ? 0 : (length - kNoiseBlock - 2) / step + 1;
}

}  // namespace duo
