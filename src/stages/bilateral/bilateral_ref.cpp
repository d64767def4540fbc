#include <algorithm>
#include <cstdlib>

#include "core/check.h"
#include "stages/bilateral/bilateral.h"

namespace duo {

std::uint8_t bilateral_at(View<const std::uint8_t> src, int range, int y, int x) {
  const int v = src.at(y, x);
  int differences = 0, weights = 0;
  for (int j = -1; j <= 1; ++j)
    for (int i = -1; i <= 1; ++i) {
      const int d = src.at(std::clamp(y + j, 0, src.height() - 1), std::clamp(x + i, 0, src.width() - 1)) - v;
      const int weight = std::max(0, range + 1 - std::abs(d));
      differences += weight * d;
      weights += weight;
    }
  // Rounded down also where the sum is negative; the mean of pixels lies between them.
  const int twice = 2 * differences + weights, by = 2 * weights;
  return static_cast<std::uint8_t>(v + (twice >= 0 ? twice / by : -((by - 1 - twice) / by)));
}

namespace ref {

void bilateral(View<const std::uint8_t> src, int range, View<std::uint8_t> dst) {
  DUO_CHECK(src.size() == dst.size() && range >= 0 && range <= kMostBilateralRange);
  for (int y = 0; y < src.height(); ++y)
    for (int x = 0; x < src.width(); ++x) dst.at(y, x) = bilateral_at(src, range, y, x);
}

}  // namespace ref
}  // namespace duo
