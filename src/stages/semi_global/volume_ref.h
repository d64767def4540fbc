// The plain volumes of semi-global matching, for the references that are made of them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "stages/semi_global/semi_global.h"

namespace duo::ref {

/// [y][x][d], d fastest.
struct Volume {
  Size size;
  int depth;
  std::vector<std::uint8_t> cells;
  Volume(Size size_, int depth_)
      : size(size_),
        depth(depth_),
        cells(static_cast<std::size_t>(size_.width) * static_cast<std::size_t>(size_.height) *
              static_cast<std::size_t>(depth_)) {}
  std::uint8_t* at(int y, int x) { return cells.data() + (static_cast<std::ptrdiff_t>(y) * size.width + x) * depth; }
  bool has(int y, int x) const { return y >= 0 && y < size.height && x >= 0 && x < size.width; }
};

/// C of every pixel and disparity.
Volume costs_of(const SemiGlobal& in);

/// Adds the costs of the paths that come from (y - dy, x - dx) to the sums.
void add_path(const SemiGlobal& in, Volume& costs, int dx, int dy, Volume& sums);

}  // namespace duo::ref
