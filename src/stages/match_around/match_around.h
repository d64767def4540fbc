// One level of the thesis's matcher: each pixel searches around the disparity found at the level below.
#pragma once

#include <cstdint>

#include "core/pool.h"
#include "duoptic/image.h"

namespace duo {

/// Disparity of a level in whole pixels; negative where a negative one won.
///
/// At the lowest level (`coarser` empty) every position of the right row is tried: d = x .. x - (width - 1). At the others
/// d runs over 2 * coarser(y / 2, x / 2) + [-radius, radius]. The candidate with the least sum over the 7x7 window wins, the
/// smallest d among equals.
///
/// Cost of one pixel: the least of |L(x) - R(x - d)| and the same against the half-way values towards both neighbours,
/// (R(x-d) + R(x-d-1) + 1) / 2 and (R(x-d) + R(x-d+1) + 1) / 2; 255 where either pixel is outside the raw picture.
/// Sums fit 16 bits: 49 * 255 = 12495.
///
/// Shape    left, right, inside pictures and dst H x W; coarser (H+1)/2 x (W+1)/2; inside pictures may be empty = all inside
/// Units    dst in px
/// Border   pictures continue by their edge pixels, rows and columns alike, for any d
/// Threads  rows are independent
/// Exact    ref, simd and vk agree bit for bit
/// Source   thesis step 2; Birchfield, Tomasi, "A pixel dissimilarity measure that is insensitive to image sampling", 1998,
///          with the two half-way values tried one by one instead of their interval
struct MatchAround {
  View<const std::uint8_t> left = {}, right = {}, left_inside = {}, right_inside = {};
  View<const std::int16_t> coarser = {};
  int radius = 0;
};

namespace ref {
/// `comparisons` counts candidates tried, when given.
void match_around(const MatchAround& in, View<std::int16_t> dst, std::int64_t* comparisons = nullptr);
}
namespace simd {
/// Right rows as the kernel wants them: mirrored, so that rising disparity is contiguous, and continued at both ends.
struct MatchAroundScratch {
  static constexpr int kPad = 64;  // >= the candidates of one step, so that a start past the ends sees edge pixels only
  Image<std::uint8_t> right, half, outside;
  static Size size_for(Size picture) { return {picture.width + 2 * kPad, picture.height}; }
  explicit MatchAroundScratch(Size picture = {}) {
    if (!picture.empty()) right = Image<std::uint8_t>(size_for(picture)), half = right.clone(), outside = right.clone();
  }
};
/// Precondition: radius <= 15 when there is a coarser level.
void match_around(Pool& pool, const MatchAround& in, MatchAroundScratch& scratch, View<std::int16_t> dst);
}  // namespace simd

}  // namespace duo
