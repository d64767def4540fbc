#include <algorithm>

#include "core/check.h"
#include "stages/halve/halve.h"

namespace duo::ref {
namespace {

template <class Of4>
void each_2x2(View<const std::uint8_t> src, View<std::uint8_t> dst, Of4 of4) {
  DUO_CHECK(dst.size() == half_of(src.size()));
  for (int y = 0; y < dst.height(); ++y)
    for (int x = 0; x < dst.width(); ++x) {
      const int y1 = std::min(2 * y + 1, src.height() - 1), x1 = std::min(2 * x + 1, src.width() - 1);
      dst.at(y, x) = static_cast<std::uint8_t>(of4(src.at(2 * y, 2 * x), src.at(2 * y, x1), src.at(y1, 2 * x), src.at(y1, x1)));
    }
}

}  // namespace

void halve(View<const std::uint8_t> src, View<std::uint8_t> dst) {
  each_2x2(src, dst, [](int a, int b, int c, int d) { return (a + b + c + d + 2) >> 2; });
}
void halve_inside(View<const std::uint8_t> src, View<std::uint8_t> dst) {
  each_2x2(src, dst, [](int a, int b, int c, int d) { return a & b & c & d; });
}

}  // namespace duo::ref
