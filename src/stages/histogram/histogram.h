// What colours an area has, and which of them tell a target from its surroundings.
#pragma once

#include <cstdint>

#include "core/pool.h"
#include "core/targets.h"

namespace duo {

// Counts the hues and saturations of an area's pixels whose value is at least `min_value` (hue means nothing in the dark).
//
// Shape    hue, saturation and value H x W
// Threads  rows are independent; counts do not depend on their order
// Exact    ref, simd and vk agree bit for bit
// Source   Swain, Ballard, "Color indexing", 1991
struct ColorCount {
  View<const std::uint8_t> hue, saturation, value;
  Area area;
  std::uint8_t min_value = 0;
};
namespace ref {
ColorHistogram color_histogram(const ColorCount& in);
}
namespace simd {
ColorHistogram color_histogram(Pool& pool, const ColorCount& in);
}

/// 1 2 1 in both directions: a few hundred pixels around a click say something about the colours beside theirs.
///
/// Border  hue goes around; saturation continues by its edge bins
/// Units   counts grow sixteenfold; bins up to 2^28 - 1 fit
ColorHistogram smoothed(const ColorHistogram& in);

/// round(255 P / (P + Q)), where P and Q are the bin's shares of the target's and of the other pixels: the probability of the
/// target if both are as likely beforehand, monotone in the ratio of the histograms. Bins with less than `min_count` of the
/// target give 0.
///
/// Units   counts below 2^27 in total, so that the products fit 64 bits
/// Exact   in integers: with t, o the bin's counts and T, O the totals (O at least 1), (510 tO + tO + oT) / 2(tO + oT)
/// Source  Jones, Rehg, "Statistical color models with application to skin detection", 2002
ColorLikelihood likelihood_of(const ColorHistogram& target, const ColorHistogram& others, std::uint32_t min_count = 1);

}  // namespace duo
