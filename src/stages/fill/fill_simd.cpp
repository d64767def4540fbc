#include "stages/fill/fill.h"

namespace duo::simd {

void mark_measured(Pool& pool, View<const std::uint16_t> d_q4, View<std::uint8_t> origin) {
  pool.rows(d_q4.height(), [&](int begin, int end) {
    const Size part{d_q4.width(), end - begin};
    ref::mark_measured(d_q4.crop(begin, 0, part), origin.crop(begin, 0, part));
  });
}

void fill(Pool& pool, View<const std::uint16_t> src, int max_disparity, View<std::uint8_t> origin, View<std::uint16_t> dst) {
  pool.rows(src.height(), [&](int begin, int end) { ref::fill(src, max_disparity, origin, dst, {begin, end}); });
}

}  // namespace duo::simd
