#include <algorithm>

#include "core/check.h"
#include "stages/gaussian/gaussian.h"

namespace duo::ref {

void gaussian5x5(View<const std::uint8_t> src, View<std::uint8_t> dst) {
  DUO_CHECK(src.size() == dst.size());
  constexpr int kWeight[5] = {1, 4, 6, 4, 1};
  const int w = src.width(), h = src.height();
  for (int y = 0; y < h; ++y)
    for (int x = 0; x < w; ++x) {
      int sum = 128;
      for (int dy = -2; dy <= 2; ++dy)
        for (int dx = -2; dx <= 2; ++dx)
          sum += kWeight[dy + 2] * kWeight[dx + 2] * src.at(std::clamp(y + dy, 0, h - 1), std::clamp(x + dx, 0, w - 1));
      dst.at(y, x) = static_cast<std::uint8_t>(sum >> 8);
    }
}

}  // namespace duo::ref
