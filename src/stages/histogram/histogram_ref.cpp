#include <algorithm>
#include <numeric>

#include "core/check.h"
#include "stages/histogram/histogram.h"

namespace duo {

ColorHistogram smoothed(const ColorHistogram& in) {
  constexpr int kWeights[3] = {1, 2, 1};
  ColorHistogram out{};
  for (int hue = 0; hue < 32; ++hue)
    for (int saturation = 0; saturation < 32; ++saturation) {
      std::uint32_t sum = 0;
      for (int i = -1; i <= 1; ++i)
        for (int j = -1; j <= 1; ++j) {
          const int bin = ((hue + i) & 31) * 32 + std::clamp(saturation + j, 0, 31);
          sum += static_cast<std::uint32_t>(kWeights[i + 1] * kWeights[j + 1]) * in[static_cast<std::size_t>(bin)];
        }
      out[static_cast<std::size_t>(hue * 32 + saturation)] = sum;
    }
  return out;
}

ColorLikelihood likelihood_of(const ColorHistogram& target, const ColorHistogram& others, std::uint32_t min_count) {
  const auto total_target = std::accumulate(target.begin(), target.end(), std::uint64_t{0});
  const auto total_others = std::max(std::accumulate(others.begin(), others.end(), std::uint64_t{0}), std::uint64_t{1});
  ColorLikelihood out{};
  for (std::size_t i = 0; i < out.size(); ++i) {
    if (target[i] == 0 || target[i] < min_count) continue;
    const std::uint64_t for_it = target[i] * total_others, against = others[i] * total_target;  // below 2^54 each
    out[i] = static_cast<std::uint8_t>((511 * for_it + against) / (2 * (for_it + against)));
  }
  return out;
}

ColorHistogram ref::color_histogram(const ColorCount& in) {
  const Size size = in.hue.size();
  DUO_CHECK(in.saturation.size() == size && in.value.size() == size && (in.area.marks.empty() || in.area.marks.size() == size));
  ColorHistogram out{};
  for (int y = 0; y < size.height; ++y)
    for (int x = 0; x < size.width; ++x) {
      if (!in.area.contains(y, x) || in.value.at(y, x) < in.min_value) continue;
      ++out[static_cast<std::size_t>(color_bin(in.hue.at(y, x), in.saturation.at(y, x)))];
    }
  return out;
}

}  // namespace duo
