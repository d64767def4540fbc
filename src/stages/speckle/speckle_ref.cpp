#include <cstdlib>
#include <utility>
#include <vector>

#include "stages/speckle/speckle.h"

namespace duo::ref {

void remove_speckle(View<std::uint16_t> d_q4, int step_q4, int smallest) {
  const int w = d_q4.width(), h = d_q4.height();
  Image<std::uint8_t> seen(d_q4.size());
  std::vector<std::pair<int, int>> island;
  for (int y0 = 0; y0 < h; ++y0)
    for (int x0 = 0; x0 < w; ++x0) {
      if (seen.at(y0, x0) != 0 || d_q4.at(y0, x0) == Disparity::kNone) continue;
      island.assign(1, {y0, x0});
      seen.at(y0, x0) = 1;
      for (std::size_t i = 0; i < island.size(); ++i) {
        const auto [y, x] = island[i];
        for (const auto& [dy, dx] : {std::pair{-1, 0}, {1, 0}, {0, -1}, {0, 1}}) {
          const int yy = y + dy, xx = x + dx;
          if (yy < 0 || yy >= h || xx < 0 || xx >= w || seen.at(yy, xx) != 0 || d_q4.at(yy, xx) == Disparity::kNone) continue;
          if (std::abs(d_q4.at(yy, xx) - d_q4.at(y, x)) > step_q4) continue;
          seen.at(yy, xx) = 1;
          island.emplace_back(yy, xx);
        }
      }
      if (static_cast<int>(island.size()) < smallest)
        for (const auto& [y, x] : island) d_q4.at(y, x) = Disparity::kNone;
    }
}

}  // namespace duo::ref
