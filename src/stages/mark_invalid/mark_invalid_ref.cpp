#include "core/check.h"
#include "stages/mark_invalid/mark_invalid.h"

namespace duo::ref {

void mark_invalid(View<const std::int16_t> winner, View<const std::uint8_t> left_inside, View<const std::uint8_t> right_inside,
                  int max_disparity, View<std::uint16_t> dst) {
  DUO_CHECK(winner.size() == dst.size());
  for (int y = 0; y < dst.height(); ++y)
    for (int x = 0; x < dst.width(); ++x) {
      const int d = winner.at(y, x);
      const bool possible = d >= 0 && d < max_disparity && d <= x;
      const bool inside = left_inside.empty() || (possible && left_inside.at(y, x) != 0 && right_inside.at(y, x - d) != 0);
      dst.at(y, x) = possible && inside ? static_cast<std::uint16_t>(16 * d) : Disparity::kNone;
    }
}

}  // namespace duo::ref
