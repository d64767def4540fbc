// How finely a pair's pictures are resolved, from the pictures alone.
#pragma once

#include <array>
#include <cstdint>

#include "core/pool.h"
#include "duoptic/image.h"
#include "stages/blur/blur_params.h"

namespace duo {

/// How much larger differences between pixels three apart are than between neighbours, in the more blurred picture, in 1/16;
/// kBlurUnknown where that cannot be told: no blocks, or a twentieth of them flat, as codecs of videos make them.
///
/// The difference 1 -2 1 / -2 4 -2 / 1 -2 1 is taken of neighbours and of pixels three apart. Its amounts are summed over
/// blocks of 8x8 pixels, corners at x = 3, 11, 19 ... and y = 3, 19, 35 ...; the sums are sorted into bins of 4. The level of a
/// picture at one distance is the middle of the bin of the first block that has a twentieth of all at or below it, and its
/// blur the ratio of both levels, rounded down. White noise has 16, sharp photographs 20 to 28; interpolation, filters and
/// JPEG take away what differs between neighbours: 32 and more. Blocks with a pixel of 0 or 255 do not count: they are outside
/// the raw picture, or saturated.
///
/// Shape    both H x W; pictures smaller than 14x14 have no blocks
/// Exact    ref, simd and vk agree: integers
/// Source   ours; the difference and the quantile are those of stages/noise
namespace ref {
int blur_q4(View<const std::uint8_t> left, View<const std::uint8_t> right);
}
namespace simd {
int blur_q4(Pool& pool, View<const std::uint8_t> left, View<const std::uint8_t> right);
}

/// How many blocks of a picture have a sum in each bin, at each distance.
using BlurBins = std::array<std::array<int, kBlurBins>, 2>;
/// Of one picture.
int blur_of_bins_q4(const BlurBins& bins);

inline int blur_bin(int sum) { return sum / kBlurBinStep < kBlurBins ? sum / kBlurBinStep : kBlurBins - 1; }

/// Blocks along `length` pixels, one each `step`.
constexpr int blur_blocks(int length, int step) {
  return length < kBlurBlock + 2 * kBlurFar ? 0 : (length - kBlurBlock - 2 * kBlurFar) / step + 1;
}

}  // namespace duo
