#include <algorithm>
#include <cstdlib>

#include "core/check.h"
#include "stages/noise/noise.h"

namespace duo {

int noise_level_q4(const NoiseBins& bins) {
  int all = 0, below = 0;
  for (const int count : bins) all += count;
  if (all == 0) return 0;
  int bin = 0;
  while (kNoiseShare * (below += bins[static_cast<std::size_t>(bin)]) < all) ++bin;
  return noise_of_bin_q4(bin);
}

namespace ref {
namespace {

constexpr int kDoesNotCount = -1;

int block_sum(View<const std::uint8_t> picture, int y0, int x0) {
  constexpr int kWeights[3] = {1, -2, 1};
  int sum = 0;
  for (int y = y0; y < y0 + kNoiseBlock; ++y)
    for (int x = x0; x < x0 + kNoiseBlock; ++x) {
      if (picture.at(y, x) == 0 || picture.at(y, x) == 255) return kDoesNotCount;
      int difference = 0;
      for (int j = -1; j <= 1; ++j)
        for (int i = -1; i <= 1; ++i) difference += kWeights[j + 1] * kWeights[i + 1] * picture.at(y + j, x + i);
      sum += std::abs(difference);
    }
  return sum;
}

int level_q4(View<const std::uint8_t> picture) {
  NoiseBins bins{};
  for (int by = 0; by < noise_blocks(picture.height(), kNoiseRowStep); ++by)
    for (int bx = 0; bx < noise_blocks(picture.width(), kNoiseBlock); ++bx) {
      const int sum = block_sum(picture, 1 + kNoiseRowStep * by, 1 + kNoiseBlock * bx);
      if (sum != kDoesNotCount) ++bins[static_cast<std::size_t>(std::min(sum / kNoiseBinStep, kNoiseBins - 1))];
    }
  return noise_level_q4(bins);
}

}  // namespace

int noise_q4(View<const std::uint8_t> left, View<const std::uint8_t> right) {
  DUO_CHECK(left.size() == right.size());
  return std::max(level_q4(left), level_q4(right));
}

}  // namespace ref
}  // namespace duo
