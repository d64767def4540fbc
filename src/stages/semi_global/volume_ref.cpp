#include "stages/semi_global/volume_ref.h"

#include <algorithm>
#include <bit>
#include <cstdlib>

namespace duo::ref {
namespace {

/// Of a value to the other one's interval.
int distance(int value, int low, int high) { return std::max({value - high, low - value, 0}); }

int cost(const SemiGlobal& in, int y, int x, int d) {
  const SemiGlobalParams& p = in.params;
  const int r = std::max(x - d, 0);
  if (in.left.outside.at(y, x) != 0 || in.right.outside.at(y, r) != 0)
    return p.census_truncation + MatchPlanes::kChannels * p.truncation;
  int bits = 0, sum = 0;
  for (std::size_t i = 0; i < in.left.census.size(); ++i)
    bits += std::popcount(static_cast<unsigned>(in.left.census[i].at(y, x) ^ in.right.census[i].at(y, r)));
  for (std::size_t c = 0; c < MatchPlanes::kChannels; ++c) {
    const int to_right = distance(in.left.value[c].at(y, x), in.right.low[c].at(y, r), in.right.high[c].at(y, r));
    const int to_left = distance(in.right.value[c].at(y, r), in.left.low[c].at(y, x), in.left.high[c].at(y, x));
    sum += std::min({to_right, to_left, p.truncation});
  }
  return std::min(bits, p.census_truncation) + sum;
}

}  // namespace

Volume costs_of(const SemiGlobal& in) {
  Volume costs(in.left.size(), in.max_disparity);
  for (int y = 0; y < costs.size.height; ++y)
    for (int x = 0; x < costs.size.width; ++x)
      for (int d = 0; d < costs.depth; ++d) costs.at(y, x)[d] = static_cast<std::uint8_t>(cost(in, y, x, d));
  return costs;
}

void add_path(const SemiGlobal& in, Volume& costs, int dx, int dy, Volume& sums) {
  const Size size = costs.size;
  const int n = costs.depth;
  Volume path(size, n);
  for (int i = 0; i < size.height; ++i)
    for (int j = 0; j < size.width; ++j) {
      const int y = dy < 0 ? size.height - 1 - i : i, x = dx < 0 ? size.width - 1 - j : j;
      const std::uint8_t* c = costs.at(y, x);
      std::uint8_t* here = path.at(y, x);
      if (!path.has(y - dy, x - dx)) {
        std::copy_n(c, n, here);
      } else {
        const std::uint8_t* before = path.at(y - dy, x - dx);
        const int least = *std::min_element(before, before + n);
        const auto gray = [&](int yy, int xx) { return int{in.left.value[0].at(yy, xx)}; };
        const int p2 = in.params.p2_at(std::abs(gray(y, x) - gray(y - dy, x - dx)));
        for (int d = 0; d < n; ++d) {
          int best = std::min<int>(before[d], least + p2);
          if (d > 0) best = std::min(best, before[d - 1] + in.params.p1);
          if (d + 1 < n) best = std::min(best, before[d + 1] + in.params.p1);
          here[d] = static_cast<std::uint8_t>(c[d] + best - least);
        }
      }
      std::uint8_t* sum = sums.at(y, x);
      for (int d = 0; d < n; ++d) sum[d] = static_cast<std::uint8_t>(std::min(255, sum[d] + here[d]));
    }
}

}  // namespace duo::ref
