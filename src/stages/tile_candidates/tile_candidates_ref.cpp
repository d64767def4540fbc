#include <algorithm>

#include "core/check.h"
#include "stages/tile_candidates/tile_candidates.h"

namespace duo {

void all_candidates(TileSets& sets) {
  for (int t = 0; t < sets.words.height(); ++t)
    for (int d = 0; d < sets.max_disparity; ++d) TileSets::add(sets.words.row(t), d);
}

namespace ref {
namespace {

/// Adds what the winners of coarse columns [x0, x1), rows [y0, y1) vote for; whether there was any.
bool vote(View<const std::int16_t> winners, int x0, int y0, int x1, int y1, const TileCandidates& in, int max_disparity, std::uint64_t* set) {
  bool any = false;
  for (int y = std::max(y0, 0); y < std::min(y1, winners.height()); ++y)
    for (int x = std::max(x0, 0); x < std::min(x1, winners.width()); ++x) {
      const int d = winners.at(y, x);
      if (d < 0) continue;
      any = true;
      for (int fine = std::max(2 * d - in.margin, 0); fine <= std::min(2 * d + 1 + in.margin, max_disparity - 1); ++fine)
        TileSets::add(set, fine);
    }
  return any;
}

}  // namespace

void tile_candidates(const TileCandidates& in, TileSets& sets) {
  DUO_CHECK(in.checked.size() == in.unchecked.size());
  constexpr int kHalfWidth = TileSets::kWidth / 2, kHalfHeight = TileSets::kHeight / 2;
  for (int ty = 0; ty < sets.tiles.height; ++ty)
    for (int tx = 0; tx < sets.tiles.width; ++tx) {
      std::uint64_t* set = sets.of(ty, tx);
      std::fill_n(set, sets.words.width(), std::uint64_t{0});
      const auto around = [&](View<const std::int16_t> winners, int grow_x, int grow_y) {
        return vote(winners, tx * kHalfWidth - grow_x, ty * kHalfHeight - grow_y, (tx + 1) * kHalfWidth + grow_x,
                    (ty + 1) * kHalfHeight + grow_y, in, sets.max_disparity, set);
      };
      const int far_x = in.grow + kHalfWidth, far_y = in.grow + kHalfHeight;
      if (!around(in.checked, in.grow, in.grow) && !around(in.checked, far_x, far_y)) around(in.unchecked, far_x, far_y);
    }
}

}  // namespace ref
}  // namespace duo
