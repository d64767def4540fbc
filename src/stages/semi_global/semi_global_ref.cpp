#include <algorithm>
#include <cstdlib>

#include "core/check.h"
#include "stages/semi_global/semi_global.h"
#include "stages/semi_global/volume_ref.h"

namespace duo::ref {
namespace {

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
  Volume costs = costs_of(in), sums(size, n);
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
