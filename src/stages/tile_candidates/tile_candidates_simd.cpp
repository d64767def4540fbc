#include <algorithm>
#include <bit>

#include "core/check.h"
#include "stages/tile_candidates/tile_candidates.h"

namespace duo::simd {
namespace {

/// The distinct winners of a rectangle as one bit each; few pixels, so scalar. `seen` has room for the coarse disparities.
bool gather(View<const std::int16_t> winners, int x0, int y0, int x1, int y1, int words, std::uint64_t* seen) {
  std::fill_n(seen, words, std::uint64_t{0});
  bool any = false;
  for (int y = std::max(y0, 0); y < std::min(y1, winners.height()); ++y)
    for (int x = std::max(x0, 0); x < std::min(x1, winners.width()); ++x) {
      const int d = winners.at(y, x);
      if (d < 0) continue;
      TileSets::add(seen, d);
      any = true;
    }
  return any;
}

}  // namespace

// As the reference, but each distinct winner is spread to its candidates once.
void tile_candidates(Pool& pool, const TileCandidates& in, TileSets& sets) {
  DUO_CHECK(in.checked.size() == in.unchecked.size());
  constexpr int kHalfWidth = TileSets::kWidth / 2, kHalfHeight = TileSets::kHeight / 2;
  constexpr int kMostWords = 64;  // coarse disparities below 4096
  const int words = (sets.max_disparity / 2 + 1 + 63) / 64;
  DUO_CHECK(words <= kMostWords);
  pool.rows(sets.tiles.height, [&](int begin, int end) {
    std::uint64_t seen[kMostWords];
    for (int ty = begin; ty < end; ++ty)
      for (int tx = 0; tx < sets.tiles.width; ++tx) {
        const auto around = [&](View<const std::int16_t> winners, int grow_x, int grow_y) {
          return gather(winners, tx * kHalfWidth - grow_x, ty * kHalfHeight - grow_y, (tx + 1) * kHalfWidth + grow_x,
                        (ty + 1) * kHalfHeight + grow_y, words, seen);
        };
        const int far_x = in.grow + kHalfWidth, far_y = in.grow + kHalfHeight;
        if (!around(in.checked, in.grow, in.grow) && !around(in.checked, far_x, far_y)) around(in.unchecked, far_x, far_y);
        std::uint64_t* set = sets.of(ty, tx);
        std::fill_n(set, sets.words.width(), std::uint64_t{0});
        for (int i = 0; i < words; ++i)
          for (std::uint64_t bits = seen[i]; bits != 0; bits &= bits - 1) {
            const int d = 64 * i + std::countr_zero(bits);
            for (int fine = std::max(2 * d - in.margin, 0); fine <= std::min(2 * d + 1 + in.margin, sets.max_disparity - 1); ++fine)
              TileSets::add(set, fine);
          }
      }
  });
}

}  // namespace duo::simd
