#include <algorithm>
#include <bit>
#include <cstdlib>
#include <vector>

#include "core/check.h"
#include "stages/semi_global/semi_global.h"

namespace duo::ref {
namespace {

/// [y][x][d], d fastest.
struct Volume {
  Size size;
  int depth;
  std::vector<std::uint8_t> cells;
  Volume(Size size_, int depth_)
      : size(size_),
        depth(depth_),
        cells(static_cast<std::size_t>(size_.width) * static_cast<std::size_t>(size_.height) *
              static_cast<std::size_t>(depth_)) {}
  std::uint8_t* at(int y, int x) { return cells.data() + (static_cast<std::ptrdiff_t>(y) * size.width + x) * depth; }
  bool has(int y, int x) const { return y >= 0 && y < size.height && x >= 0 && x < size.width; }
};

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

/// Adds the costs of the paths that come from (y - dy, x - dx) to the sums.
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

/// Mean of the vertices of a parabola and of a V, in 1/256 of half a pixel.
int vertex_256(int slope, int higher, int sum) {
  const int height = higher * sum;
  return (128 * slope * (higher + sum) + height / 2) / height;
}

int sub_pixel_q4(const std::uint8_t* s, int d, int n) {
  if (d == 0 || d + 1 == n) return 0;
  const int before = s[d - 1] - s[d], after = s[d + 1] - s[d], higher = std::max(before, after), slope = before - after;
  if (higher == 0) return 0;
  const int t = vertex_256(std::abs(slope), higher, before + after);
  const int size = (t * (768 - t) + 8192) >> 14;
  return slope < 0 ? -size : size;
}

int margin(const std::uint8_t* s, int d, int n) {
  int second = 255;
  for (int e = 0; e < n; ++e)
    if (std::abs(e - d) > 1) second = std::min<int>(second, s[e]);
  return second - s[d];
}

}  // namespace

void semi_global(const SemiGlobal& in, const SemiGlobalMatch& out) {
  const Size size = in.left.size();
  const int n = in.max_disparity;
  DUO_CHECK(n >= 1 && n <= 256 && out.left.size() == size && out.right.size() == size && out.fine.size() == size);
  Volume costs(size, n), sums(size, n);
  for (int y = 0; y < size.height; ++y)
    for (int x = 0; x < size.width; ++x)
      for (int d = 0; d < n; ++d) costs.at(y, x)[d] = static_cast<std::uint8_t>(cost(in, y, x, d));
  add_path(in, costs, 1, 0, sums);
  add_path(in, costs, -1, 0, sums);
  for (const int dy : {1, -1}) {
    if (dy < 0 && !in.params.upward) continue;
    add_path(in, costs, 0, dy, sums);
    if (!in.params.diagonals) continue;
    add_path(in, costs, 1, dy, sums);
    add_path(in, costs, -1, dy, sums);
  }
  for (int y = 0; y < size.height; ++y)
    for (int x = 0; x < size.width; ++x) {
      const std::uint8_t* s = sums.at(y, x);
      const int d = static_cast<int>(std::min_element(s, s + n) - s);
      out.left.at(y, x) = static_cast<std::int16_t>(d);
      out.fine.at(y, x) = static_cast<std::uint16_t>(16 * d + sub_pixel_q4(s, d, n));
      if (!out.margin.empty()) out.margin.at(y, x) = static_cast<std::uint8_t>(margin(s, d, n));
      int right = 0;
      for (int e = 1; e < n && x + e < size.width; ++e)
        if (sums.at(y, x + e)[e] < sums.at(y, x + right)[right]) right = e;
      out.right.at(y, x) = static_cast<std::int16_t>(right);
    }
}

}  // namespace duo::ref
