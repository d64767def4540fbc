#include <algorithm>
#include <array>

#include "core/check.h"
#include "stages/median/median.h"

namespace duo::ref {
namespace {

template <class T>
void median(View<const T> src, View<T> dst) {
  DUO_CHECK(src.size() == dst.size());
  const int w = src.width(), h = src.height();
  for (int y = 0; y < h; ++y)
    for (int x = 0; x < w; ++x) {
      std::array<T, 9> v;
      int n = 0;
      for (int dy = -1; dy <= 1; ++dy)
        for (int dx = -1; dx <= 1; ++dx) v[n++] = src.at(std::clamp(y + dy, 0, h - 1), std::clamp(x + dx, 0, w - 1));
      std::nth_element(v.begin(), v.begin() + 4, v.end());
      dst.at(y, x) = v[4];
    }
}

}  // namespace

void median3x3(View<const std::uint8_t> src, View<std::uint8_t> dst) { median(src, dst); }
void median3x3(View<const std::uint16_t> src, View<std::uint16_t> dst) { median(src, dst); }

}  // namespace duo::ref
