// Loops that compilers make vectors of.
#include <algorithm>
#include <cstdlib>
#include <mutex>

#include "core/check.h"
#include "stages/noise/noise.h"

namespace duo::simd {
namespace {

constexpr int kNoiseRun = 32;                      // blocks worked on together
constexpr int kNoiseColumns = kNoiseRun * kNoiseBlock;  // a column sums up to 8 * 4080: 16 bits

/// Adds the blocks of one row of them, `blocks` from column x0 - 1 on.
void add_blocks(View<const std::uint8_t> picture, int y0, int x0, int blocks, NoiseBins& bins) {
  std::int16_t down[kNoiseColumns + 2];
  std::uint16_t sums[kNoiseColumns] = {};
  std::uint8_t at_end[kNoiseColumns] = {};  // not 0: a pixel is 0 or 255
  const int columns = blocks * kNoiseBlock;
  for (int y = y0; y < y0 + kNoiseBlock; ++y) {
    const std::uint8_t *above = picture.row(y - 1) + x0, *here = picture.row(y) + x0, *below = picture.row(y + 1) + x0;
    for (int x = 0; x < columns + 2; ++x) down[x] = static_cast<std::int16_t>(above[x] - 2 * here[x] + below[x]);
    for (int x = 0; x < columns; ++x) {
      const auto difference = static_cast<std::int16_t>(down[x] - 2 * down[x + 1] + down[x + 2]);
      sums[x] = static_cast<std::uint16_t>(sums[x] + std::abs(difference));
    }
    for (int x = 0; x < columns; ++x) at_end[x] |= static_cast<std::uint8_t>(here[x + 1] + 1) < 2 ? 1 : 0;
  }
  for (int block = 0; block < blocks; ++block) {
    int sum = 0, ends = 0;
    for (int i = block * kNoiseBlock; i < (block + 1) * kNoiseBlock; ++i) sum += sums[i], ends |= at_end[i];
    if (ends == 0) ++bins[static_cast<std::size_t>(std::min(sum / kNoiseBinStep, kNoiseBins - 1))];
  }
}

}  // namespace

int noise_q4(Pool& pool, View<const std::uint8_t> left, View<const std::uint8_t> right) {
  DUO_CHECK(left.size() == right.size());
  const int across = noise_blocks(left.width(), kNoiseBlock), down = noise_blocks(left.height(), kNoiseRowStep);
  NoiseBins all[2] = {};
  std::mutex mutex;
  pool.rows(across > 0 ? down : 0, [&](int begin, int end) {
    NoiseBins bins[2] = {};
    for (int view = 0; view < 2; ++view)
      for (int by = begin; by < end; ++by)
        for (int bx = 0; bx < across; bx += kNoiseRun)
          add_blocks(view == 0 ? left : right, 1 + kNoiseRowStep * by, kNoiseBlock * bx, std::min(kNoiseRun, across - bx),
                     bins[view]);
    const std::lock_guard lock(mutex);
    for (int view = 0; view < 2; ++view)
      for (std::size_t i = 0; i < bins[view].size(); ++i) all[view][i] += bins[view][i];
  });
  return std::max(noise_level_q4(all[0]), noise_level_q4(all[1]));
}

}  // namespace duo::simd
