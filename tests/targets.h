// Random targets: every kind of colour, windows inside, across and outside the border.
#pragma once

#include <random>

#include "duoptic/frame.h"
#include "stages/mark_targets/mark_targets.h"
#include "tests/agree.h"

namespace duo::test {

inline Target random_target(std::mt19937& rng, Size size) {
  const auto below = [&](int n) { return static_cast<int>(rng() % static_cast<unsigned>(n)); };
  Target out;
  out.color = {static_cast<std::uint8_t>(rng()), static_cast<std::uint8_t>(below(130)), static_cast<std::uint8_t>(below(64)),
               static_cast<std::uint8_t>(below(64))};
  out.window = below(3) == 0 ? Window::all(size)
                             : Window{below(size.width + 4) - 4, below(size.height + 4) - 4, below(size.width + 8),
                                      below(size.height + 8)};
  return out;
}

/// Disparities as a matcher leaves them: mostly in a range, some far out of it, a fifth missing.
inline void fill_disparity(View<std::uint16_t> d_q4, std::mt19937& rng) {
  for (int y = 0; y < d_q4.height(); ++y)
    for (int x = 0; x < d_q4.width(); ++x)
      d_q4.at(y, x) = static_cast<std::uint16_t>(rng() % 5 == 0    ? Disparity::kNone
                                                 : rng() % 20 == 0 ? rng() % Disparity::kNone
                                                                   : rng() % 1200);
}

}  // namespace duo::test
