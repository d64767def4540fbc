#include "stages/check_left_right/check_left_right.h"

#include <cstdlib>

#include "core/check.h"

namespace duo::ref {

bool consistent(const CheckLeftRight& in, int y, int x) {
  const int d = in.left.at(y, x);
  if (d < 0 || d > x) return false;
  if (!in.left_inside.empty() && (in.left_inside.at(y, x) == 0 || in.right_inside.at(y, x - d) == 0)) return false;
  for (int xr = x - d - in.reach; xr <= x - d + in.reach; ++xr) {
    if (xr < 0 || xr >= in.right.width()) continue;
    const int other = in.right.at(y, xr);
    if (other >= 0 && std::abs(other - d) <= in.tolerance) return true;
  }
  return false;
}

void check_winners(const CheckLeftRight& in, View<std::int16_t> dst) {
  DUO_CHECK(in.left.size() == in.right.size() && in.left.size() == dst.size());
  for (int y = 0; y < dst.height(); ++y)
    for (int x = 0; x < dst.width(); ++x) dst.at(y, x) = consistent(in, y, x) ? in.left.at(y, x) : std::int16_t{-1};
}

void check_left_right(const CheckLeftRight& in, View<const std::uint16_t> fine, View<std::uint16_t> dst) {
  DUO_CHECK(in.left.size() == in.right.size() && in.left.size() == dst.size() && in.left.size() == fine.size());
  for (int y = 0; y < dst.height(); ++y)
    for (int x = 0; x < dst.width(); ++x) dst.at(y, x) = consistent(in, y, x) ? fine.at(y, x) : Disparity::kNone;
}

}  // namespace duo::ref
