// Pixels and parts of a picture.
#pragma once

#include <algorithm>
#include <cstdint>
#include <cstring>

#include "duoptic/image.h"
#include "duoptic/window.h"

namespace duo {

struct Pixel {
  std::int32_t y = -1, x = -1;  // -1: none
  bool found() const { return y >= 0; }
  friend bool operator==(const Pixel&, const Pixel&) = default;
};

/// Pixels whose centre lies at most `radius_px` from that of (x, y); the whole plane where radius_px < 0.
///
/// Units   |coordinates| and radius below 2^15 px, so that squares fit 32 bits
struct Disc {
  int x = 0, y = 0, radius_px = -1;
  /// How far to both sides of x it reaches in row py; -1 = not at all.
  int reach(int py) const {
    const int rest = radius_px * radius_px - (py - y) * (py - y);
    int out = -1;
    while ((out + 1) * (out + 1) <= rest) ++out;
    return out;
  }
  bool contains(int py, int px) const {
    return radius_px < 0 || (px - x) * (px - x) + (py - y) * (py - y) <= radius_px * radius_px;
  }
};

/// The pixels inside a window, inside a disc, and marked with any of `bits`.
///
/// Shape   marks: of the picture, or empty = all are marked
struct Area {
  Window window;
  Disc disc = {};
  View<const std::uint8_t> marks = {};
  std::uint8_t bits = 0xFF;

  bool marked(int y, int x) const { return marks.empty() || (marks.at(y, x) & bits) != 0; }
  bool contains(int y, int x) const { return window.contains(y, x) && disc.contains(y, x) && marked(y, x); }

  /// The first marked column of row y in [x, end), or end. Marks are mostly empty: eight at a time.
  int next_marked(int y, int x, int end) const {
    if (marks.empty() || (x < end && marked(y, x))) return x;
    const std::uint8_t* row = marks.row(y);
    while (x + 8 <= end && !any_marked(row + x)) x += 8;
    while (x < end && (row[x] & bits) == 0) ++x;
    return x;
  }

  /// The smallest window that holds all of it in a picture of this size.
  Window bounds(Size size) const {
    const Window inside = window.within(size);
    if (disc.radius_px < 0) return inside;
    const int side = 2 * disc.radius_px + 1;
    const Window around{disc.x - disc.radius_px, disc.y - disc.radius_px, side, side};
    const int x0 = std::max(inside.x, around.x), y0 = std::max(inside.y, around.y);
    return {x0, y0, std::max(std::min(inside.x_end(), around.x_end()) - x0, 0),
            std::max(std::min(inside.y_end(), around.y_end()) - y0, 0)};
  }

 private:
  bool any_marked(const std::uint8_t* eight) const {
    std::uint64_t word = 0;
    std::memcpy(&word, eight, sizeof word);
    return (word & 0x0101010101010101u * bits) != 0;
  }
};

/// Calls f(y, begin, end) for rows [y_begin, y_end) of an area's bounds with the columns that lie in its window and disc.
template <class F>
void each_row(const Area& area, const Window& bounds, int y_begin, int y_end, F&& f) {
  for (int y = y_begin; y < y_end; ++y) {
    int begin = bounds.x, end = bounds.x_end();
    if (area.disc.radius_px >= 0) {
      const int reach = area.disc.reach(y);
      begin = std::max(begin, area.disc.x - reach);
      end = std::min(end, area.disc.x + reach + 1);
    }
    if (begin < end) f(y, begin, end);
  }
}

}  // namespace duo
