#include "pipeline/flat_picture.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <utility>

namespace duo {
namespace {

constexpr int kBlock = 4;

int brightness(const Rgb8& p) { return p.r + 2 * p.g + p.b; }  // in quarters of a level

/// Standard deviation of a pixel's noise, in quarters of a level: from the median of what neighbours differ by.
double noise_of(View<const Rgb8> picture) {
  constexpr int kRows = 16;
  constexpr double kOfMedian = 1.4826 / 1.4142;  // a normal distribution, of differences of two
  std::array<int, 1021> count{};
  int total = 0;
  for (int y = 0; y < picture.height(); y += kRows)
    for (int x = 0; x + 1 < picture.width(); ++x, ++total)
      ++count[static_cast<std::size_t>(std::abs(brightness(picture.row(y)[x + 1]) - brightness(picture.row(y)[x])))];
  std::size_t median = 0;
  for (int below = count[0]; below * 2 < total; below += count[++median]) continue;
  return kOfMedian * static_cast<double>(median);
}

int block_sum(View<const Rgb8> picture, int x, int y) {
  int sum = 0;
  for (int v = 0; v < kBlock; ++v)
    for (int u = 0; u < kBlock; ++u) sum += brightness(picture.row(y + v)[x + u]);
  return sum;
}

template <class T>
Image<T> filled(Size size, T value) {
  if (size.empty()) return {};
  Image<T> out(size);
  for (int y = 0; y < size.height; ++y) std::fill_n(out.row(y), size.width, value);
  return out;
}

template <class T>
Image<T> copy_of(const Image<T>& image) {
  return image.empty() ? Image<T>() : image.clone();
}

/// A frame, and the one whose maps on a device it still names.
struct FrameOf {
  Frame frame;
  std::shared_ptr<const Frame> made;
};

}  // namespace

bool is_flat(View<const Rgb8> picture) {
  constexpr double kLeastStep = 2, kStepOfNoise = 1.5;  // levels; standard deviations: four of what two blocks differ by
  constexpr double kShare = 0.005;
  const int columns = picture.width() / kBlock, rows = picture.height() / kBlock;
  if (columns < 2 || rows < 2) return false;
  const double step = 4 * kBlock * kBlock * std::max(kLeastStep, kStepOfNoise * noise_of(picture) / 4);
  const double enough = kShare * 2 * columns * rows;
  int steps = 0;
  for (int y = 0; y + 1 < rows; ++y)
    for (int x = 0; x + 1 < columns; ++x) {
      const int here = block_sum(picture, kBlock * x, kBlock * y);
      steps += std::abs(block_sum(picture, kBlock * (x + 1), kBlock * y) - here) > step;
      steps += std::abs(block_sum(picture, kBlock * x, kBlock * (y + 1)) - here) > step;
      if (steps > enough) return false;
    }
  return true;
}

std::shared_ptr<const Frame> without_depth(std::shared_ptr<const Frame> frame) {
  const auto out = std::make_shared<FrameOf>();
  const Frame& from = *frame;
  out->frame = {.sequence = from.sequence,
                .t_ns = from.t_ns,
                .skew_ns = from.skew_ns,
                .left = copy_of(from.left),
                .right = copy_of(from.right),
                .left_inside = copy_of(from.left_inside),
                .right_inside = copy_of(from.right_inside),
                .color = copy_of(from.color),
                .disparity = {filled(from.disparity.d_q4.size(), Disparity::kNone),
                              filled(from.disparity.origin.size(), static_cast<std::uint8_t>(Origin::kNone))},
                .matched = from.matched,
                .confidence = filled(from.confidence.size(), std::uint8_t{0}),
                .depth_mm = filled(from.depth_mm.size(), std::uint16_t{0}),
                .on_device = from.on_device,
                .stages = from.stages};
  out->made = std::move(frame);
  return {out, &out->frame};
}

}  // namespace duo
