#include "stages/align_time/block_flow.h"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <utility>

namespace duo::ref {
namespace {

constexpr int kFlowBlock = 4, kFlowWindow = 8;  // cells: side of a block, and of what is compared for it

}  // namespace

BlockFlow::BlockFlow(Size picture) {
  constexpr int kColumns = 320;
  step_ = std::max(1, (picture.width + kColumns / 2) / kColumns);
  width_ = picture.width / step_;
  height_ = picture.height / step_;
  // Too small for a window: no blocks, nothing moves.
  columns_ = width_ < kFlowWindow || height_ < kFlowWindow ? 0 : width_ / kFlowBlock;
  rows_ = height_ / kFlowBlock;
  now_.resize(static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_));
  before_.resize(now_.size());
  cells_.resize(now_.size());
  blocks_.resize(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_));
}

void BlockFlow::see(const Image<Rgb8>& picture) {
  std::swap(now_, before_);
  const int pixels = step_ * step_ * 4;
  for (int y = 0; y < height_; ++y)
    for (int x = 0; x < width_; ++x) {
      int sum = 0;
      for (int v = y * step_; v < (y + 1) * step_; ++v) {
        const Rgb8* p = picture.row(v) + x * step_;
        for (int u = 0; u < step_; ++u) sum += p[u].r + 2 * p[u].g + p[u].b;
      }
      now_[static_cast<std::size_t>(y * width_ + x)] = static_cast<std::uint8_t>(sum / pixels);
    }
}

/// Sum of absolute differences over a window.
int BlockFlow::cost(int x, int y, int was_x, int was_y) const {
  const std::uint8_t *a = now_.data() + y * width_ + x, *b = before_.data() + was_y * width_ + was_x;
  int sum = 0;
  for (int v = 0; v < kFlowWindow; ++v, a += width_, b += width_)
    for (int u = 0; u < kFlowWindow; ++u) sum += std::abs(a[u] - b[u]);
  return sum;
}

Way BlockFlow::search(int block_x, int block_y) const {
  constexpr int kReach = 14;                             // cells
  constexpr int kStill = 4 * kFlowWindow * kFlowWindow;  // 4 levels: noise of a webcam, averaged over a cell
  constexpr int kToll = 4;                               // a cell: without texture the shorter way wins
  constexpr int kEnoughNum = 4, kEnoughDen = 5;  // of the cost of standing still; else it is something else that came to light
  constexpr int kMargin = (kFlowWindow - kFlowBlock) / 2;
  const int x0 = std::clamp(block_x * kFlowBlock - kMargin, 0, width_ - kFlowWindow),
            y0 = std::clamp(block_y * kFlowBlock - kMargin, 0, height_ - kFlowWindow);
  const int still = cost(x0, y0, x0, y0);
  if (still < kStill) return {};
  int best = still, best_x = x0, best_y = y0;
  for (int y = std::max(0, y0 - kReach); y <= std::min(height_ - kFlowWindow, y0 + kReach); ++y)
    for (int x = std::max(0, x0 - kReach); x <= std::min(width_ - kFlowWindow, x0 + kReach); ++x) {
      const int c = cost(x0, y0, x, y) + kToll * (std::abs(x - x0) + std::abs(y - y0));
      if (c < best) best = c, best_x = x, best_y = y;
    }
  if (best * kEnoughDen > still * kEnoughNum) return {};
  // Two lines of equal slope through the costs on either side: of absolute differences, the better fit than a parabola.
  const auto part_q4 = [&](int ox, int oy) {
    const auto at = [&](int k) {
      return cost(x0, y0, std::clamp(best_x + k * ox, 0, width_ - kFlowWindow),
                  std::clamp(best_y + k * oy, 0, height_ - kFlowWindow));
    };
    const int a = at(-1), middle = at(0), b = at(1), top = std::max(a, b) - middle;
    return top > 0 ? std::clamp(8 * (a - b) / top, -8, 8) : 0;
  };
  return {16 * (x0 - best_x) - part_q4(1, 0), 16 * (y0 - best_y) - part_q4(0, 1)};
}

int BlockFlow::cost_of_cell(int x, int y, Way way) const {
  const auto at = [&](const std::vector<std::uint8_t>& of, int u, int v) {
    return of[static_cast<std::size_t>(std::clamp(v, 0, height_ - 1) * width_ + std::clamp(u, 0, width_ - 1))];
  };
  const int dx = (way.x_q4 + 8) >> 4, dy = (way.y_q4 + 8) >> 4;
  int sum = 0;
  for (int v = y - 1; v <= y + 1; ++v)
    for (int u = x - 1; u <= x + 1; ++u) sum += std::abs(at(now_, u, v) - at(before_, u - dx, v - dy));
  return sum;
}

/// Gives the cells of a block their ways.
void BlockFlow::choose(int block_x, int block_y) {
  std::array<Way, 9> ways;
  std::size_t count = 0;
  for (int v = std::max(0, block_y - 1); v <= std::min(rows_ - 1, block_y + 1); ++v)
    for (int u = std::max(0, block_x - 1); u <= std::min(columns_ - 1, block_x + 1); ++u) {
      const Way way = blocks_[static_cast<std::size_t>(v * columns_ + u)];
      const auto end = ways.begin() + static_cast<std::ptrdiff_t>(count);
      if (std::find(ways.begin(), end, way) == end) ways[count++] = way;
    }
  for (int y = block_y * kFlowBlock; y < (block_y + 1) * kFlowBlock; ++y)
    for (int x = block_x * kFlowBlock; x < (block_x + 1) * kFlowBlock; ++x) {
      Way& best = cells_[static_cast<std::size_t>(y * width_ + x)];
      best = ways[0];
      if (count == 1) continue;
      int least = cost_of_cell(x, y, best);
      for (std::size_t k = 1; k < count; ++k)
        if (const int c = cost_of_cell(x, y, ways[k]); c < least) least = c, best = ways[k];
    }
}

const std::vector<Way>& BlockFlow::find() {
  for (int y = 0; y < rows_; ++y)
    for (int x = 0; x < columns_; ++x) blocks_[static_cast<std::size_t>(y * columns_ + x)] = search(x, y);
  for (int y = 0; y < rows_; ++y)
    for (int x = 0; x < columns_; ++x) choose(x, y);
  return cells_;
}

}  // namespace duo::ref
