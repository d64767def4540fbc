// The rows in which a stage's result is needed.
#pragma once

#include <algorithm>
#include <limits>
#include <span>

#include "duoptic/image.h"
#include "duoptic/window.h"

namespace duo {

/// Rows [begin, end); by default all.
struct RowBand {
  int begin = 0, end = std::numeric_limits<int>::max();

  bool all(int height) const { return begin <= 0 && end >= height; }
  RowBand within(int height) const { return {std::clamp(begin, 0, height), std::clamp(end, 0, height)}; }
  /// With `rows` more on both sides, as far as the picture goes.
  RowBand grown(int rows, int height) const {
    const RowBand here = within(height);
    return {std::max(here.begin - rows, 0), std::min(here.end + rows, height)};
  }
  int count() const { return std::max(end - begin, 0); }
  /// These rows of a picture; an empty view stays empty.
  template <class T>
  View<T> of(View<T> picture) const {
    return picture.empty() ? picture : picture.crop(begin, 0, {picture.width(), count()});
  }
  /// The rows that any of the windows has; without windows all.
  static RowBand of(std::span<const Window> windows, Size size) {
    if (windows.empty()) return RowBand{}.within(size.height);
    RowBand out{size.height, 0};
    for (const Window& each : windows) {
      const Window window = each.within(size);
      if (!window.empty()) out = {std::min(out.begin, window.y), std::max(out.end, window.y_end())};
    }
    return out.begin < out.end ? out : RowBand{0, 0};
  }
};

}  // namespace duo
