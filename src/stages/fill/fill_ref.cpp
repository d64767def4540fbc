#include <algorithm>

#include "core/check.h"
#include "stages/fill/fill.h"

namespace duo::ref {

void mark_measured(View<const std::uint16_t> d_q4, View<std::uint8_t> origin) {
  DUO_CHECK(d_q4.size() == origin.size());
  for (int y = 0; y < d_q4.height(); ++y)
    for (int x = 0; x < d_q4.width(); ++x)
      origin.at(y, x) = static_cast<std::uint8_t>(d_q4.at(y, x) == Disparity::kNone ? Origin::kNone : Origin::kMeasured);
}

void fill(View<std::uint16_t> d_q4, View<std::uint8_t> origin) {
  DUO_CHECK(d_q4.size() == origin.size());
  constexpr auto kMeasured = static_cast<std::uint8_t>(Origin::kMeasured);
  const int w = d_q4.width();
  for (int y = 0; y < d_q4.height(); ++y)
    for (int x = 0; x < w; ++x) {
      if (origin.at(y, x) != static_cast<std::uint8_t>(Origin::kNone)) continue;
      int left = x, right = x;
      while (left >= 0 && origin.at(y, left) != kMeasured) --left;
      while (right < w && origin.at(y, right) != kMeasured) ++right;
      if (left < 0 && right >= w) continue;
      const std::uint16_t from_left = left >= 0 ? d_q4.at(y, left) : Disparity::kNone;
      const std::uint16_t from_right = right < w ? d_q4.at(y, right) : Disparity::kNone;
      d_q4.at(y, x) = std::min(from_left, from_right);
      origin.at(y, x) = static_cast<std::uint8_t>(Origin::kFilled);
    }
}

}  // namespace duo::ref
