#include "stages/color_median/color_median.h"

#include <algorithm>
#include <cstdlib>

#include "core/check.h"

namespace duo {
namespace {

struct ColorTap {
  std::uint16_t value, weight;
};

/// Of a vote, in 1/64: near taps say more, and what was filled says less than what was measured.
int vote_weight(const ColorMedian& in, int y, int x, int ty, int tx) {
  const int near = ColorMedian::kHalf_px2 * 64 / (ColorMedian::kHalf_px2 + (ty - y) * (ty - y) + (tx - x) * (tx - x));
  return in.chosen.at(ty, tx) != 0 ? near / ColorMedian::kChosenCount : near;
}

std::uint16_t color_median_at(const ColorMedian& in, int y, int x) {
  constexpr int kAlong = ColorMedian::kMostRadius + 1;
  std::array<ColorTap, kAlong * kAlong> taps;
  std::size_t count = 0;
  int total = 0;
  const Rgb8 own = in.guide.at(y, x);
  for (int ty = y - in.radius; ty <= y + in.radius; ty += ColorMedian::kStep) {
    if (ty < 0 || ty >= in.d_q4.height()) continue;
    for (int tx = x - in.radius; tx <= x + in.radius; tx += ColorMedian::kStep) {
      if (tx < 0 || tx >= in.d_q4.width() || in.d_q4.at(ty, tx) == Disparity::kNone) continue;
      const Rgb8 other = in.guide.at(ty, tx);
      const int step = std::abs(own.r - other.r) + std::abs(own.g - other.g) + std::abs(own.b - other.b);
      if (step >= 64) continue;
      const int weight = ColorMedian::kWeights[static_cast<std::size_t>(step / 4)] *
                         (in.chosen.empty() ? 1 : vote_weight(in, y, x, ty, tx));
      taps[count++] = {in.d_q4.at(ty, tx), static_cast<std::uint16_t>(weight)};
      total += taps[count - 1].weight;
    }
  }
  std::sort(taps.begin(), taps.begin() + static_cast<std::ptrdiff_t>(count),
            [](const ColorTap& a, const ColorTap& b) { return a.value < b.value; });
  int sum = 0;
  for (std::size_t k = 0; k < count; ++k) {
    sum += taps[k].weight;
    if (2 * sum >= total) return taps[k].value;
  }
  return in.d_q4.at(y, x);
}

void color_median_rows(const ColorMedian& in, int begin, int end, View<std::uint16_t> dst) {
  for (int y = begin; y < end; ++y)
    for (int x = 0; x < dst.width(); ++x) {
      const bool stays = in.d_q4.at(y, x) == Disparity::kNone || (!in.chosen.empty() && in.chosen.at(y, x) == 0);
      dst.at(y, x) = stays ? in.d_q4.at(y, x) : color_median_at(in, y, x);
    }
}

void check_color_median(const ColorMedian& in, View<std::uint16_t> dst) {
  DUO_CHECK(in.d_q4.size() == dst.size() && in.guide.size() == dst.size());
  DUO_CHECK(in.chosen.empty() || in.chosen.size() == dst.size());
  DUO_CHECK(in.radius >= 2 && in.radius <= ColorMedian::kMostRadius && in.radius % 2 == 0);
}

}  // namespace

void ref::color_median(const ColorMedian& in, View<std::uint16_t> dst) {
  check_color_median(in, dst);
  color_median_rows(in, 0, dst.height(), dst);
}

void simd::color_median(Pool& pool, const ColorMedian& in, View<std::uint16_t> dst) {
  check_color_median(in, dst);
  pool.rows(dst.height(), [&](int begin, int end) { color_median_rows(in, begin, end, dst); });
}

}  // namespace duo
