// One pass over each row: holes come in runs, and a run has one answer. What was measured between them is skipped by memchr.

#include <algorithm>
#include <cstring>

#include "core/check.h"
#include "stages/fill/fill.h"

namespace duo::simd {

void mark_measured(Pool& pool, View<const std::uint16_t> d_q4, View<std::uint8_t> origin) {
  pool.rows(d_q4.height(), [&](int begin, int end) {
    const Size part{d_q4.width(), end - begin};
    ref::mark_measured(d_q4.crop(begin, 0, part), origin.crop(begin, 0, part));
  });
}

void fill(Pool& pool, View<std::uint16_t> d_q4, View<std::uint8_t> origin) {
  DUO_CHECK(d_q4.size() == origin.size());
  const int w = d_q4.width();
  pool.rows(d_q4.height(), [&](int y_begin, int y_end) {
    for (int y = y_begin; y < y_end; ++y) {
      std::uint16_t* d = d_q4.row(y);
      std::uint8_t* from = origin.row(y);
      for (int x = 0; x < w;) {
        const void* hole = std::memchr(from + x, static_cast<int>(Origin::kNone), static_cast<std::size_t>(w - x));
        if (hole == nullptr) break;
        x = static_cast<int>(static_cast<const std::uint8_t*>(hole) - from);
        const std::uint16_t before = x > 0 ? d[x - 1] : Disparity::kNone;
        int end = x;
        while (end < w && from[end] == static_cast<std::uint8_t>(Origin::kNone)) ++end;
        const std::uint16_t value = std::min(before, end < w ? d[end] : Disparity::kNone);
        if (value != Disparity::kNone) {
          std::fill(d + x, d + end, value);
          std::fill(from + x, from + end, static_cast<std::uint8_t>(Origin::kFilled));
        }
        x = end;
      }
    }
  });
}

}  // namespace duo::simd
