#include <algorithm>
#include <cstring>

#include "core/check.h"
#include "stages/semi_global/semi_global.h"

namespace duo::simd {

SemiGlobalScratch::SemiGlobalScratch(Size size, int max_disparity, const SemiGlobalParams& params, int threads)
    : most(size),
      most_lanes(padding(max_disparity)),
      lanes(most_lanes),
      stride(lanes + kGap),
      none({std::max(lanes + 2 * kGap, size.width + 2), 1}),
      rows_each(threads > 1 && !params.diagonals && !params.upward ? kBehind + 1 : 2),
      rows(static_cast<std::size_t>(rows_each) * static_cast<std::size_t>(threads)) {
  const int directions = params.diagonals ? 3 : 1;
  for (int i = 0; i < threads + (threads > 1 ? 2 : 1); ++i) {
    paths.emplace_back(Size{(size.width + 2) * stride + kGap, directions});
    minima.emplace_back(Size{size.width + 2, directions});
  }
  for (Row& row : rows) {
    row.sums = Image<std::uint8_t>({size.width * lanes, 1});
    row.costs = Image<std::uint8_t>({size.width * lanes, 1});
    for (Image<std::uint8_t>* path : {&row.along, &row.back}) *path = Image<std::uint8_t>({lanes + 2 * kGap, 2});
    row.totals = Image<std::uint8_t>({lanes + 2 * kGap, 1});
    row.best = Image<std::uint8_t>({lanes + size.width, 1});
    row.winner = Image<std::uint8_t>({lanes + size.width, 1});
    row.beside = Image<std::uint8_t>({size.width, 2});
  }
  if (params.upward) volume = Image<std::uint8_t>({size.width * lanes, size.height});
  if (rows_each > 2) {
    for (Image<std::uint8_t>& costs : met_costs) costs = Image<std::uint8_t>({lanes + kGap, size.height});
    met_least = Image<std::uint8_t>({size.height, 2});
    for (Image<std::uint8_t>* found : {&left_best, &right_best, &right_winner})
      *found = Image<std::uint8_t>({lanes, size.height});
  }
  sums = std::make_unique<std::atomic<int>[]>(2);
  done = std::make_unique<std::atomic<int>[]>(2 * static_cast<std::size_t>(size.height));
  lanes = 0;
  fit(size, max_disparity);
}

void SemiGlobalScratch::fit(Size size, int max_disparity) {
  const int needed = padding(max_disparity);
  DUO_CHECK(size.width <= most.width && size.height <= most.height && needed <= most_lanes);
  if (lanes != needed) {
    lanes = needed;
    stride = lanes + kGap;
    const auto fill = [](Image<std::uint8_t>& image) {
      for (int y = 0; y < image.height(); ++y) std::memset(image.row(y), 255, static_cast<std::size_t>(image.width()));
    };
    for (Image<std::uint8_t>& ring : paths) fill(ring);
    for (Row& row : rows) fill(row.along), fill(row.back);
  }
  for (std::size_t i = 0; i < paths.size(); ++i)
    for (int k = 0; k < paths[i].height(); ++k)
      for (const int x : {-1, size.width}) {
        std::memset(first_cell(paths[i].row(k)) + static_cast<std::ptrdiff_t>(x) * stride, 0, static_cast<std::size_t>(lanes));
        minima[i].row(k)[x + 1] = 0;
      }
}

}  // namespace duo::simd
