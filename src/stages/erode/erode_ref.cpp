#include <algorithm>

#include "core/check.h"
#include "stages/erode/erode.h"

namespace duo::ref {

void erode(View<const std::uint8_t> src, Neighbours neighbours, View<std::uint8_t> dst) {
  DUO_CHECK(src.size() == dst.size());
  for (int y = 0; y < src.height(); ++y)
    for (int x = 0; x < src.width(); ++x) {
      int all = 0xFF;
      for (int dy = -1; dy <= 1; ++dy)
        for (int dx = -1; dx <= 1; ++dx) {
          if (neighbours == Neighbours::kFour && dy != 0 && dx != 0) continue;
          all &= src.at(std::clamp(y + dy, 0, src.height() - 1), std::clamp(x + dx, 0, src.width() - 1));
        }
      dst.at(y, x) = static_cast<std::uint8_t>(all);
    }
}

}  // namespace duo::ref
