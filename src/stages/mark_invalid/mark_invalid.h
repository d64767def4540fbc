// Whole-pixel winners to disparities, with what cannot be a match marked.
#pragma once

#include <cstdint>

#include "core/pool.h"
#include "duoptic/frame.h"

namespace duo {

// dst = 16 d, or Disparity::kNone where d is negative or >= max_disparity, where x - d lies left of the right picture, or where
// either pixel is outside its raw picture.
//
// Shape    winner, inside pictures and dst H x W; inside pictures may be empty = all inside
// Units    winner px, dst 1/16 px
// Threads  rows are independent
// Exact    ref, simd and vk agree bit for bit
// Source   thesis step 2: no continuity or uniqueness constraint; where no match is found the pixel is marked
namespace ref {
void mark_invalid(View<const std::int16_t> winner, View<const std::uint8_t> left_inside, View<const std::uint8_t> right_inside,
                  int max_disparity, View<std::uint16_t> dst);
}
namespace simd {
void mark_invalid(Pool& pool, View<const std::int16_t> winner, View<const std::uint8_t> left_inside,
                  View<const std::uint8_t> right_inside, int max_disparity, View<std::uint16_t> dst);
}

}  // namespace duo
