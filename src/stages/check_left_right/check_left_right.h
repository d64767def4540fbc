// Left-right check: what the right view sees elsewhere is hidden or wrong.
#pragma once

#include <cstdint>

#include "core/pool.h"
#include "duoptic/frame.h"
#include "stages/types/gray_pair.h"

namespace duo {

/// Keeps a left winner d where the right view's winner at x - d, or at most `reach` columns beside it, differs from d by at
/// most `tolerance`; and where both pixels are inside their raw pictures. With d > x there is no other pixel, and d is not
/// kept.
///
/// check_winners: dst = winner or -1. check_left_right: dst = fine or Disparity::kNone.
///
/// Shape    all H x W; inside pictures may be empty = all inside; dst of ref and simd may be fine itself
/// Units    left, right px (-1 = none); fine and dst 1/16 px
/// Threads  rows are independent
/// Exact    ref, simd and vk agree bit for bit
/// Source   Fua, "A parallel stereo algorithm that produces dense depth maps and preserves image features", 1993; reach > 0 is
///          ours: on slanted surfaces the right view's winner for this surface often falls one column beside
struct CheckLeftRight {
  View<const std::int16_t> left, right;
  View<const std::uint8_t> left_inside = {}, right_inside = {};
  int tolerance = 1, reach = 0;
};

namespace ref {
/// Whether one pixel's winner is kept.
bool consistent(const CheckLeftRight& in, int y, int x);
void check_winners(const CheckLeftRight& in, View<std::int16_t> dst);
void check_left_right(const CheckLeftRight& in, View<const std::uint16_t> fine, View<std::uint16_t> dst);
}  // namespace ref
namespace simd {
void check_winners(Pool& pool, const CheckLeftRight& in, View<std::int16_t> dst);
void check_left_right(Pool& pool, const CheckLeftRight& in, View<const std::uint16_t> fine, View<std::uint16_t> dst);
}  // namespace simd

}  // namespace duo
