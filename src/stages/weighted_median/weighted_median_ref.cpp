#include <algorithm>
#include <cstdlib>
#include <utility>
#include <vector>

#include "core/check.h"
#include "stages/weighted_median/weighted_median.h"

namespace duo::ref {
namespace {

constexpr int kRadius = WeightedMedian::kRadius, kStep = WeightedMedian::kStep;

std::uint16_t median_around(const WeightedMedian& in, int y, int x) {
  std::vector<std::pair<std::uint16_t, int>> taps;  // value, weight
  int total = 0;
  for (int ty = y - kRadius; ty <= y + kRadius; ty += kStep)
    for (int tx = x - kRadius; tx <= x + kRadius; tx += kStep) {
      if (ty < 0 || ty >= in.d_q4.height() || tx < 0 || tx >= in.d_q4.width()) continue;
      const std::uint16_t value = in.d_q4.at(ty, tx);
      const std::size_t entry = static_cast<std::size_t>(std::abs(in.guide.at(ty, tx) - in.guide.at(y, x)) / 4);
      if (value == Disparity::kNone || entry >= WeightedMedian::kWeights.size()) continue;
      taps.emplace_back(value, WeightedMedian::kWeights[entry]);
      total += WeightedMedian::kWeights[entry];
    }
  std::sort(taps.begin(), taps.end());
  int sum = 0;
  for (const auto& [value, weight] : taps) {
    sum += weight;
    if (2 * sum >= total) return value;
  }
  return in.d_q4.at(y, x);
}

}  // namespace

void weighted_median(const WeightedMedian& in, View<std::uint16_t> dst) {
  DUO_CHECK(in.d_q4.size() == dst.size() && in.guide.size() == dst.size());
  for (int y = 0; y < dst.height(); ++y)
    for (int x = 0; x < dst.width(); ++x)
      dst.at(y, x) = in.d_q4.at(y, x) == Disparity::kNone ? Disparity::kNone : median_around(in, y, x);
}

}  // namespace duo::ref
