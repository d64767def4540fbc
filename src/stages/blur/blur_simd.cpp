// Loops that compilers make vectors of.
#include <algorithm>
#include <cstdlib>
#include <mutex>

#include "core/check.h"
#include "stages/blur/blur.h"

namespace duo::simd {
namespace {

constexpr int kBlurRun = 32;                     // blocks worked on together
constexpr int kBlurColumns = kBlurRun * kBlurBlock;  // a column sums up to 8 * 4080: 16 bits

/// Adds the amounts of one row's differences to the sums of its columns; column 0 is kBlurFar pixels behind the rows' first.
template <int kDistance>
void add_row(const std::uint8_t* above, const std::uint8_t* here, const std::uint8_t* below, int columns, std::uint16_t* sums) {
  std::int16_t down[kBlurColumns + 2 * kDistance];
  constexpr int kFirst = kBlurFar - kDistance;
  for (int x = 0; x < columns + 2 * kDistance; ++x)
    down[x] = static_cast<std::int16_t>(above[kFirst + x] - 2 * here[kFirst + x] + below[kFirst + x]);
  for (int x = 0; x < columns; ++x) {
    const auto difference = static_cast<std::int16_t>(down[x] - 2 * down[x + kDistance] + down[x + 2 * kDistance]);
    sums[x] = static_cast<std::uint16_t>(sums[x] + std::abs(difference));
  }
}

/// Adds the blocks of one row of them, `blocks` from column x0 + kBlurFar on.
void add_blocks(View<const std::uint8_t> picture, int y0, int x0, int blocks, BlurBins& bins) {
  std::uint16_t near[kBlurColumns] = {}, far[kBlurColumns] = {};
  std::uint8_t at_end[kBlurColumns] = {};  // not 0: a pixel is 0 or 255
  const int columns = blocks * kBlurBlock;
  for (int y = y0; y < y0 + kBlurBlock; ++y) {
    const auto row = [&](int by) { return picture.row(y + by) + x0; };
    add_row<1>(row(-1), row(0), row(1), columns, near);
    add_row<kBlurFar>(row(-kBlurFar), row(0), row(kBlurFar), columns, far);
    for (int x = 0; x < columns; ++x) at_end[x] |= static_cast<std::uint8_t>(row(0)[x + kBlurFar] + 1) < 2 ? 1 : 0;
  }
  for (int block = 0; block < blocks; ++block) {
    int near_sum = 0, far_sum = 0, ends = 0;
    for (int i = block * kBlurBlock; i < (block + 1) * kBlurBlock; ++i)
      near_sum += near[i], far_sum += far[i], ends |= at_end[i];
    if (ends != 0) continue;
    ++bins[0][static_cast<std::size_t>(blur_bin(near_sum))];
    ++bins[1][static_cast<std::size_t>(blur_bin(far_sum))];
  }
}

}  // namespace

int blur_q4(Pool& pool, View<const std::uint8_t> left, View<const std::uint8_t> right) {
  DUO_CHECK(left.size() == right.size());
  const int across = blur_blocks(left.width(), kBlurBlock), down = blur_blocks(left.height(), kBlurRowStep);
  BlurBins all[2] = {};
  std::mutex mutex;
  pool.rows(across > 0 ? down : 0, [&](int begin, int end) {
    BlurBins bins[2] = {};
    for (int view = 0; view < 2; ++view)
      for (int by = begin; by < end; ++by)
        for (int bx = 0; bx < across; bx += kBlurRun)
          add_blocks(view == 0 ? left : right, kBlurFar + kBlurRowStep * by, kBlurBlock * bx, std::min(kBlurRun, across - bx),
                     bins[view]);
    const std::lock_guard lock(mutex);
    for (int view = 0; view < 2; ++view)
      for (std::size_t distance = 0; distance < 2; ++distance)
        for (std::size_t i = 0; i < kBlurBins; ++i) all[view][distance][i] += bins[view][distance][i];
  });
  return std::max(blur_of_bins_q4(all[0]), blur_of_bins_q4(all[1]));
}

}  // namespace duo::simd
