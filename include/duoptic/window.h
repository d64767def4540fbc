// A rectangle of a picture.
#pragma once

#include <algorithm>

#include "duoptic/image.h"

namespace [[gnu::visibility("default")]] duo {

/// Columns [x, x + width) of rows [y, y + height). May reach over the picture's border; stages look at what lies inside.
struct Window {
  int x = 0, y = 0, width = 0, height = 0;
  friend bool operator==(const Window&, const Window&) = default;

  static Window all(Size size) { return {0, 0, size.width, size.height}; }
  bool empty() const { return width <= 0 || height <= 0; }
  int x_end() const { return x + width; }
  int y_end() const { return y + height; }
  bool contains(int py, int px) const { return px >= x && px < x_end() && py >= y && py < y_end(); }
  Window within(Size size) const {
    const int x0 = std::max(x, 0), y0 = std::max(y, 0);
    return {x0, y0, std::max(std::min(x_end(), size.width) - x0, 0), std::max(std::min(y_end(), size.height) - y0, 0)};
  }
};

}  // namespace duo
