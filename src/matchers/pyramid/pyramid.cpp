#include "matchers/pyramid/pyramid.h"

#include <algorithm>

#include "stages/halve/halve.h"
#include "stages/tile_candidates/tile_candidates.h"

namespace duo {

std::vector<PyramidLevel> make_levels(const PyramidParams& params, const MatchSetup& setup) {
  const bool tiles = params.search == PyramidParams::Search::kTiles;
  std::vector<PyramidLevel> levels(static_cast<std::size_t>(params.levels));
  Size size = setup.size;
  int max_disparity = std::min(setup.max_disparity, size.width);  // beyond that no pixel has a partner
  for (std::size_t i = 0; i < levels.size(); ++i) {
    PyramidLevel& level = levels[i];
    level.size = size;
    level.max_disparity = max_disparity;
    level.left_winner = Image<std::int16_t>(size);
    if (i > 0) {
      level.left = Image<std::uint8_t>(size);
      level.right = Image<std::uint8_t>(size);
      if (setup.masked) {
        level.left_inside = Image<std::uint8_t>(size);
        level.right_inside = Image<std::uint8_t>(size);
      }
    }
    if (tiles) {
      level.right_winner = Image<std::int16_t>(size);
      level.checked = Image<std::int16_t>(size);
      level.fine = Image<std::uint16_t>(size);
      level.sets = TileSets(size, max_disparity);
    }
    size = half_of(size);
    max_disparity = (max_disparity + 1) / 2;
  }
  if (tiles) all_candidates(levels.back().sets);
  return levels;
}

int radius_of(const PyramidParams& params, int level) {
  const int n = params.levels - level;
  return n >= 2 ? params.d_t_half_px << (n - 2) : 0;
}

}  // namespace duo
