#include <algorithm>
#include <cstdlib>

#include "core/check.h"
#include "stages/lucas_kanade/lucas_kanade.h"

namespace duo {

int LucasKanadeSums::step_q4() const {
  if (weight == 0) return 0;
  const int size = std::min(LucasKanade::kMost_q4, (2 * std::abs(pull) / weight + 1) / 2);
  return pull > 0 ? -size : size;
}

namespace ref {

LucasKanadeSums lucas_kanade_tap(const LucasKanade& in, int y, int x) {
  if (x % 2 != 0 || y % 2 != 0) return {};
  const int w = in.d_q4.width(), d = in.d_q4.at(y, x);
  if (d == Disparity::kNone || x == 0 || x + 1 >= w) return {};
  const int at_q4 = 16 * x - d, r = at_q4 >> 4, f = at_q4 & 15;
  if (r < 1 || r + 2 >= w) return {};
  const std::uint8_t *const left = in.left.row(y) + x, *const right = in.right.row(y) + r;
  const int e = 16 * left[0] - (right[0] * (16 - f) + right[1] * f);
  if (std::abs(e) >= 16 * LucasKanade::kMostDifference) return {};
  const int l_q1 = left[1] - left[-1], r_q5 = (right[1] - right[-1]) * (16 - f) + (right[2] - right[0]) * f;
  const int g_q2 = (16 * l_q1 + r_q5 + 8) >> 4, size = std::abs(g_q2);
  const int weight = lucas_kanade_weight(std::max(l_q1 * r_q5, 0) >> 2, lucas_kanade_inverse(size));
  return {(g_q2 < 0 ? -e : e) * lucas_kanade_pull(size), weight};
}

void lucas_kanade(const LucasKanade& in, View<std::uint16_t> dst) {
  const Size size = in.d_q4.size();
  DUO_CHECK(in.left.size() == size && in.right.size() == size && dst.size() == size && in.max_disparity >= 1);
  const RowBand rows = in.rows.within(size.height);
  for (int y = rows.begin; y < rows.end; ++y)
    for (int x = 0; x < size.width; ++x) {
      dst.at(y, x) = in.d_q4.at(y, x);
      if (dst.at(y, x) == Disparity::kNone) continue;
      LucasKanadeSums sums;
      for (int v = y / 2 - LucasKanade::kReach; v <= y / 2 + LucasKanade::kReach; ++v)
        for (int u = x / 2 - LucasKanade::kReach; u <= x / 2 + LucasKanade::kReach; ++u)
          if (v >= 0 && 2 * v < size.height && u >= 0 && 2 * u < size.width) sums.add(lucas_kanade_tap(in, 2 * v, 2 * u));
      dst.at(y, x) = static_cast<std::uint16_t>(std::clamp(dst.at(y, x) + sums.step_q4(), 0, 16 * (in.max_disparity - 1)));
    }
}

}  // namespace ref
}  // namespace duo
