// Plain rows in parallel: counting into a table is no work for lanes. Each thread counts for itself.

#include <mutex>

#include "core/check.h"
#include "stages/histogram/histogram.h"

namespace duo::simd {

ColorHistogram color_histogram(Pool& pool, const ColorCount& in) {
  const Size size = in.hue.size();
  DUO_CHECK(in.saturation.size() == size && in.value.size() == size && (in.area.marks.empty() || in.area.marks.size() == size));
  const Window bounds = in.area.bounds(size);
  ColorHistogram out{};
  std::mutex merge;
  pool.rows(bounds.height, [&](int from, int to) {
    ColorHistogram mine{};
    each_row(in.area, bounds, bounds.y + from, bounds.y + to, [&](int y, int begin, int end) {
      const std::uint8_t *hue = in.hue.row(y), *saturation = in.saturation.row(y), *value = in.value.row(y);
      for (int x = in.area.next_marked(y, begin, end); x < end; x = in.area.next_marked(y, x + 1, end))
        if (value[x] >= in.min_value) ++mine[static_cast<std::size_t>(color_bin(hue[x], saturation[x]))];
    });
    const std::lock_guard lock(merge);
    for (std::size_t i = 0; i < out.size(); ++i) out[i] += mine[i];
  });
  return out;
}

}  // namespace duo::simd
