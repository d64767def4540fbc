#include <algorithm>
#include <cmath>
#include <vector>

#include "stages/sift/functions.h"
#include "stages/sift/kernels.h"

namespace duo {
namespace sift {
namespace {

void blur(View<const float> src, const BlurKernel& kernel, View<float> dst, View<float> difference, int begin, int end) {
  const int w = src.width(), h = src.height();
  std::vector<float> column(static_cast<std::size_t>(w));
  for (int y = begin; y < end; ++y) {
    for (int x = 0; x < w; ++x) {
      float sum = src.at(y, x) * kernel.weight[0];
      for (int i = 1; i <= kernel.radius; ++i)
        sum += (src.at(std::max(y - i, 0), x) + src.at(std::min(y + i, h - 1), x)) * kernel.weight[i];
      column[static_cast<std::size_t>(x)] = sum;
    }
    const auto at = [&](int x) { return column[static_cast<std::size_t>(std::clamp(x, 0, w - 1))]; };
    for (int x = 0; x < w; ++x) {
      float sum = at(x) * kernel.weight[0];
      for (int i = 1; i <= kernel.radius; ++i) sum += (at(x - i) + at(x + i)) * kernel.weight[i];
      dst.at(y, x) = sum;
      if (!difference.empty()) difference.at(y, x) = sum - src.at(y, x);
    }
  }
}

bool is_extremum(const View<const float> (&differences)[3], float threshold, int y, int x) {
  const float value = differences[1].at(y, x);
  if (!(std::abs(value) > threshold)) return false;
  for (const View<const float>& difference : differences)
    for (int dy = -1; dy <= 1; ++dy)
      for (int dx = -1; dx <= 1; ++dx) {
        const float other = difference.at(y + dy, x + dx);
        if (value > 0 ? other > value : other < value) return false;
      }
  return true;
}

void mark(const View<const float> (&differences)[3], float threshold, View<std::uint8_t> marks, int x_begin, int x_end,
          int begin, int end) {
  for (int y = begin; y < end; ++y)
    for (int x = x_begin; x < x_end; ++x) marks.at(y, x) = is_extremum(differences, threshold, y, x);
}

float turns_of(float dx, float dy) {
  const float ax = std::abs(dx), ay = std::abs(dy);
  const float z = std::min(ax, ay) / std::max(std::max(ax, ay), 1e-30f), zz = z * z;
  float turns = z * (kAtan[0] + zz * (kAtan[1] + zz * (kAtan[2] + zz * (kAtan[3] + zz * kAtan[4]))));
  if (ay > ax) turns = 0.25f - turns;
  if (dx < 0) turns = 0.5f - turns;
  if (dy < 0) turns = 1 - turns;
  return turns;
}

void gradient(View<const float> src, View<float> magnitude, View<float> turns, int begin, int end) {
  for (int y = begin; y < end; ++y)
    for (int x = 1; x < src.width() - 1; ++x) {
      const float dx = src.at(y, x + 1) - src.at(y, x - 1), dy = src.at(y + 1, x) - src.at(y - 1, x);
      magnitude.at(y, x) = std::sqrt(dx * dx + dy * dy);
      turns.at(y, x) = turns_of(dx, dy);
    }
}

/// Halves to even.
std::int32_t rounded(float value) { return static_cast<std::int32_t>(std::nearbyint(value)); }

/// Histogram units of one sample, below 2^21.
float value_of(const Gradient& gradient, const Neighbourhood& n, int y, int x) {
  return gradient.magnitude.at(y, x) * n.y_weight[y - n.y_begin] * n.x_weight[x - n.x_begin];
}

void directions(const Gradient& gradient, const Neighbourhood& n, std::int32_t* histogram) {
  for (int y = n.y_begin; y < n.y_end; ++y)
    for (int x = n.x_begin; x < n.x_end; ++x) {
      const int direction = rounded(gradient.turns.at(y, x) * kDirections);
      histogram[direction % kDirections] += rounded(value_of(gradient, n, y, x));
    }
}

void cells(const Gradient& gradient, const Neighbourhood& n, const CellFrame& frame, std::int32_t* histogram) {
  constexpr float kShift = (kCells + 1) * 0.5f;  // the centre, counted from the middle of the outermost cells
  for (int y = n.y_begin; y < n.y_end; ++y)
    for (int x = n.x_begin; x < n.x_end; ++x) {
      const float dx = static_cast<float>(x) - n.x, dy = static_cast<float>(y) - n.y;
      const float column = dx * frame.cos + dy * frame.sin + kShift, row = dy * frame.cos - dx * frame.sin + kShift;
      if (!(column > 0 && column < kCells + 1 && row > 0 && row < kCells + 1)) continue;
      float direction = (gradient.turns.at(y, x) - frame.turns) * kCellDirections;
      if (direction < 0) direction += kCellDirections;

      const int c = static_cast<int>(column), r = static_cast<int>(row), d = static_cast<int>(direction);
      const float to_c = column - static_cast<float>(c), to_r = row - static_cast<float>(r),
                  to_d = direction - static_cast<float>(d);
      const float value = value_of(gradient, n, y, x);
      for (int i = 0; i < 8; ++i) {
        const float in_row = value * ((i & 4) ? to_r : 1 - to_r);
        const float in_cell = in_row * ((i & 2) ? to_c : 1 - to_c);
        const float share = in_cell * ((i & 1) ? to_d : 1 - to_d);
        const int cell = (r + (i >> 2)) * kBins + c + (i >> 1 & 1);
        histogram[cell * kCellDirections + (d + (i & 1)) % kCellDirections] += rounded(share);
      }
    }
}

constexpr Kernels kPlain = {blur, mark, gradient, directions, cells};

}  // namespace
}  // namespace sift

namespace ref {

void sift(View<const std::uint8_t> src, const Window& window, const SiftParams& params, SiftPoints& out) {
  Pool alone(1);
  SiftScratch scratch({window.width, window.height}, out.capacity(), params);
  sift::run(sift::kPlain, alone, src, window, params, scratch, out);
}

}  // namespace ref
}  // namespace duo
