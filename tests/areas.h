// Random areas of a picture for the observation stages: windows and discs inside, across and outside its border.
#pragma once

#include <random>

#include "core/area.h"
#include "tests/agree.h"

namespace duo::test {

inline Area random_area(std::mt19937& rng, Size size, View<const std::uint8_t> marks) {
  const auto below = [&](int n) { return static_cast<int>(rng() % static_cast<unsigned>(n)); };
  Area out;
  out.window = below(2) == 0 ? Window::all(size)
                             : Window{below(size.width + 4) - 4, below(size.height + 4) - 4, below(size.width + 8),
                                      below(size.height + 8)};
  if (below(2) == 0)
    out.disc = {below(size.width + 8) - 4, below(size.height + 8) - 4, below(std::max(size.width, size.height))};
  if (below(4) != 0) out.marks = marks;
  out.bits = static_cast<std::uint8_t>(below(3) == 0 ? 1 << below(8) : below(256));
  return out;
}

/// Mostly 0, with runs: what marks look like.
inline void fill_marks(View<std::uint8_t> marks, std::mt19937& rng) {
  for (int y = 0; y < marks.height(); ++y) {
    std::uint8_t mark = 0;
    for (int x = 0; x < marks.width(); ++x) {
      if (rng() % 6 == 0) mark = rng() % 2 == 0 ? 0 : static_cast<std::uint8_t>(rng());
      marks.at(y, x) = mark;
    }
  }
}

}  // namespace duo::test
