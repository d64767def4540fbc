#include <algorithm>
#include <cstdlib>

#include "core/check.h"
#include "stages/blur/blur.h"

namespace duo {

int blur_of_bins_q4(const BlurBins& bins) {
  const auto level = [&](std::size_t distance) {
    int all = 0, below = 0;
    for (const int count : bins[distance]) all += count;
    std::size_t bin = 0;
    while (all > 0 && kBlurShare * (below += bins[distance][bin]) < all) ++bin;
    return static_cast<int>(bin);
  };
  const int near = level(0), far = level(1);  // both 0 without a block
  return near == 0 ? kBlurUnknown : std::min(16 * (2 * far + 1) / (2 * near + 1), kBlurUnknown);
}

namespace ref {
namespace {

int difference(View<const std::uint8_t> picture, int y, int x, int distance) {
  constexpr int kWeights[3] = {1, -2, 1};
  int sum = 0;
  for (int j = -1; j <= 1; ++j)
    for (int i = -1; i <= 1; ++i) sum += kWeights[j + 1] * kWeights[i + 1] * picture.at(y + j * distance, x + i * distance);
  return std::abs(sum);
}

void add_block(View<const std::uint8_t> picture, int y0, int x0, BlurBins& bins) {
  int near = 0, far = 0;
  for (int y = y0; y < y0 + kBlurBlock; ++y)
    for (int x = x0; x < x0 + kBlurBlock; ++x) {
      if (picture.at(y, x) == 0 || picture.at(y, x) == 255) return;
      near += difference(picture, y, x, 1);
      far += difference(picture, y, x, kBlurFar);
    }
  ++bins[0][static_cast<std::size_t>(blur_bin(near))];
  ++bins[1][static_cast<std::size_t>(blur_bin(far))];
}

int picture_blur_q4(View<const std::uint8_t> picture) {
  BlurBins bins{};
  for (int by = 0; by < blur_blocks(picture.height(), kBlurRowStep); ++by)
    for (int bx = 0; bx < blur_blocks(picture.width(), kBlurBlock); ++bx)
      add_block(picture, kBlurFar + kBlurRowStep * by, kBlurFar + kBlurBlock * bx, bins);
  return blur_of_bins_q4(bins);
}

}  // namespace

int blur_q4(View<const std::uint8_t> left, View<const std::uint8_t> right) {
  DUO_CHECK(left.size() == right.size());
  return std::max(picture_blur_q4(left), picture_blur_q4(right));
}

}  // namespace ref
}  // namespace duo
