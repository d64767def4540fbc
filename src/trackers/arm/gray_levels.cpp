#include "trackers/arm/gray_levels.h"

#include <algorithm>

#include "core/check.h"

namespace duo::arm {
namespace {

GrayLevel level_of(int width, int height) {
  return {width, height, std::vector<std::uint8_t>(static_cast<std::size_t>(width) * static_cast<std::size_t>(height))};
}

}  // namespace

GrayLevels::GrayLevels(const Rectified& rectified)
    : step(std::max(1, (rectified.size.width + kMostColumns / 2) / kMostColumns)) {
  camera = in_blocks(rectified, step);
  full = level_of(rectified.size.width / step, rectified.size.height / step);
  half = level_of(full.width / 2, full.height / 2);
}

void GrayLevels::build(const Frame& frame) {
  DUO_CHECK(frame.left.width() / step == full.width && frame.left.height() / step == full.height);
  for (int y = 0; y < full.height; ++y) {
    std::uint8_t* out = full.pixels.data() + static_cast<std::ptrdiff_t>(y) * full.width;
    if (step == 1) {
      std::copy_n(frame.left.row(y), full.width, out);
      continue;
    }
    for (int x = 0; x < full.width; ++x) {
      int sum = 0;
      for (int v = y * step; v < (y + 1) * step; ++v)
        for (int u = x * step; u < (x + 1) * step; ++u) sum += frame.left.at(v, u);
      out[x] = static_cast<std::uint8_t>(sum / (step * step));
    }
  }
  for (int y = 0; y < half.height; ++y) {
    std::uint8_t* out = half.pixels.data() + static_cast<std::ptrdiff_t>(y) * half.width;
    const std::uint8_t *a = full.at(0, 2 * y), *b = full.at(0, 2 * y + 1);
    for (int x = 0; x < half.width; ++x)
      out[x] = static_cast<std::uint8_t>((a[2 * x] + a[2 * x + 1] + b[2 * x] + b[2 * x + 1] + 2) / 4);
  }
}

}  // namespace duo::arm
