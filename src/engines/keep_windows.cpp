#include "engines/keep_windows.h"

#include <algorithm>

namespace duo {
namespace {

template <class T>
void clear(Image<T>& map, int y, int begin, int end, T none) {
  if (map.height() > y) std::fill(map.row(y) + begin, map.row(y) + end, none);
}

}  // namespace

void keep_windows(std::span<const Window> windows, Frame& frame) {
  if (windows.empty()) return;
  const auto [w, h] = frame.disparity.d_q4.size();
  for (int y = 0; y < h; ++y)
    for (int x = 0; x < w;) {
      // From x on either a window that has it, or nothing up to the next one's left side.
      int inside_to = x, outside_to = w;
      for (const Window& window : windows) {
        if (y < window.y || y >= window.y_end() || x >= window.x_end() || window.empty()) continue;
        if (window.x <= x)
          inside_to = std::max(inside_to, window.x_end());
        else
          outside_to = std::min(outside_to, window.x);
      }
      if (inside_to > x) {
        x = inside_to;
        continue;
      }
      clear(frame.disparity.d_q4, y, x, outside_to, Disparity::kNone);
      clear(frame.disparity.origin, y, x, outside_to, static_cast<std::uint8_t>(Origin::kNone));
      clear(frame.confidence, y, x, outside_to, std::uint8_t{0});
      clear(frame.depth_mm, y, x, outside_to, std::uint16_t{0});
      x = outside_to;
    }
}

}  // namespace duo
