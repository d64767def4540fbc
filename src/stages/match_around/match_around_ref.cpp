#include <algorithm>
#include <cstdlib>

#include "core/check.h"
#include "stages/match_around/match_around.h"

namespace duo::ref {
namespace {

constexpr int kReach = 3;  // 7x7 window

int pixel_cost(const MatchAround& in, int y, int x, int d) {
  const int w = in.left.width(), h = in.left.height();
  const auto clamp_x = [&](int v) { return std::clamp(v, 0, w - 1); };
  y = std::clamp(y, 0, h - 1);
  const int xr = clamp_x(x - d), xl = clamp_x(x);
  if (!in.left_inside.empty() && (in.left_inside.at(y, xl) == 0 || in.right_inside.at(y, xr) == 0)) return 255;
  const int l = in.left.at(y, xl), r = in.right.at(y, xr);
  const int before = in.right.at(y, clamp_x(x - d - 1)), after = in.right.at(y, clamp_x(x - d + 1));
  return std::min({std::abs(l - r), std::abs(l - (r + before + 1) / 2), std::abs(l - (r + after + 1) / 2)});
}

int window_cost(const MatchAround& in, int y, int x, int d) {
  int sum = 0;
  for (int dy = -kReach; dy <= kReach; ++dy)
    for (int dx = -kReach; dx <= kReach; ++dx) sum += pixel_cost(in, y + dy, x + dx, d);
  return sum;
}

}  // namespace

void match_around(const MatchAround& in, View<std::int16_t> dst, std::int64_t* comparisons) {
  DUO_CHECK(in.left.size() == in.right.size() && in.left.size() == dst.size());
  const int w = dst.width(), h = dst.height();
  for (int y = 0; y < h; ++y)
    for (int x = 0; x < w; ++x) {
      int first = x - (w - 1), last = x;
      if (!in.coarser.empty()) {
        const int centre = 2 * in.coarser.at(y / 2, x / 2);
        first = centre - in.radius;
        last = centre + in.radius;
      }
      int best = first, best_cost = window_cost(in, y, x, first);
      for (int d = first + 1; d <= last; ++d)
        if (const int cost = window_cost(in, y, x, d); cost < best_cost) {
          best = d;
          best_cost = cost;
        }
      if (comparisons != nullptr) *comparisons += last - first + 1;
      dst.at(y, x) = static_cast<std::int16_t>(best);
    }
}

}  // namespace duo::ref
