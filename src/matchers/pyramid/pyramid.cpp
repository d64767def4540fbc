#include "matchers/pyramid/pyramid.h"

#include <algorithm>

#include "stages/halve/halve.h"
#include "stages/tile_candidates/tile_candidates.h"

namespace duo {

std::vector<LevelShape> level_shapes(const PyramidParams& params, const MatchSetup& setup) {
  std::vector<LevelShape> shapes;
  LevelShape shape{setup.size, std::min(setup.max_disparity, setup.size.width)};  // beyond that no pixel has a partner
  for (int i = 0; i < params.levels; ++i) {
    shapes.push_back(shape);
    shape = {half_of(shape.size), (shape.max_disparity + 1) / 2};
  }
  return shapes;
}

std::vector<PyramidLevel> make_levels(const PyramidParams& params, const MatchSetup& setup) {
  const bool tiles = params.search == PyramidParams::Search::kTiles;
  std::vector<PyramidLevel> levels;
  for (const auto& [size, max_disparity] : level_shapes(params, setup)) {
    const bool full = levels.empty();
    PyramidLevel& level = levels.emplace_back();
    level.size = size;
    level.max_disparity = max_disparity;
    level.left_winner = Image<std::int16_t>(size);
    if (!full) {
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
  }
  if (tiles) all_candidates(levels.back().sets);
  return levels;
}

int radius_of(const PyramidParams& params, int level) {
  const int n = params.levels - level;
  return n >= 2 ? params.d_t_half_px << (n - 2) : 0;
}

}  // namespace duo
