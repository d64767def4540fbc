// Colour to hue, saturation, value: skin and cloth stay together there while the light changes.
#pragma once

#include <cstdint>

#include "core/pool.h"
#include "duoptic/image.h"

namespace duo {

/// Three pictures of one size.
struct HsvPlanes {
  View<std::uint8_t> hue, saturation, value;
  Size size() const { return hue.size(); }
};

// Hexcone model in integers. With M, m the largest and smallest of (r, g, b) and D = M - m, rounded to the nearest, halves up:
//   value      = M
//   saturation = (510 D + M) / 2M                      (0 for black)
//   hue        = ((256 N + 3 D) / 6D) mod 256          (0 for gray), 256 = full circle, where
//   N          = g - b, + 6 D if negative, if M is red; else b - r + 2 D if M is green; else r - g + 4 D
//
// Shape    src and all of dst H x W
// Border   none
// Threads  rows are independent
// Exact    ref, simd and vk agree bit for bit. The quotients are those of integers below 2^24, so a correctly rounded float
// division,
//          truncated, gives them too: n/d falls short of the next integer by at least 1/d, more than the rounding (n/d) 2^-24
// Source   Smith, "Color gamut transform pairs", 1978
namespace ref {
void hsv(View<const Rgb8> src, const HsvPlanes& dst);
}
namespace simd {
void hsv(Pool& pool, View<const Rgb8> src, const HsvPlanes& dst);
}

}  // namespace duo
