#include "stages/mark_invalid/mark_invalid.h"

namespace duo::simd {

// One read and one write a pixel: the plain rows, in parallel.
void mark_invalid(Pool& pool, View<const std::int16_t> winner, View<const std::uint8_t> left_inside,
                  View<const std::uint8_t> right_inside, int max_disparity, View<std::uint16_t> dst) {
  pool.rows(dst.height(), [&](int begin, int end) {
    const Size part{dst.width(), end - begin};
    const auto rows = [&](View<const std::uint8_t> v) { return v.empty() ? v : v.crop(begin, 0, part); };
    ref::mark_invalid(winner.crop(begin, 0, part), rows(left_inside), rows(right_inside), max_disparity, dst.crop(begin, 0, part));
  });
}

}  // namespace duo::simd
