#include <algorithm>
#include <array>

#include "core/check.h"
#include "stages/crop_square16/crop_square16.h"

namespace duo {
namespace {

/// a / b rounded down, b > 0.
std::int64_t floor_quotient(std::int64_t a, std::int64_t b) { return a / b - (a % b < 0); }

struct CropPixel {
  int r, g, b;
};

CropPixel pixel_at(View<const Rgb8> picture, int y, int x, Outside outside) {
  if (outside == Outside::kBlack && (y < 0 || y >= picture.height() || x < 0 || x >= picture.width())) return {0, 0, 0};
  const Rgb8 p = picture.at(std::clamp(y, 0, picture.height() - 1), std::clamp(x, 0, picture.width() - 1));
  return {p.r, p.g, p.b};
}

constexpr int kMostSide = 1024;

void crop_rows(View<const Rgb8> picture, const TurnedSquare& region, Outside outside, int offset, Tensor16 out, int begin,
               int end) {
  const int n = out.width();
  std::array<std::int32_t, kMostSide> column_x, column_y;
  for (int j = 0; j < n; ++j) {
    const std::int64_t k = 256 * (2 * j + 1 - n);
    column_x[j] = 256 * region.x_q8 + static_cast<std::int32_t>(floor_quotient(k * region.right_x_q8, n));
    column_y[j] = 256 * region.y_q8 + static_cast<std::int32_t>(floor_quotient(k * region.right_y_q8, n));
  }
  for (int i = begin; i < end; ++i) {
    const std::int64_t l = 256 * (2 * i + 1 - n);
    const auto row_x = static_cast<std::int32_t>(floor_quotient(-l * region.right_y_q8, n));
    const auto row_y = static_cast<std::int32_t>(floor_quotient(l * region.right_x_q8, n));
    for (int j = 0; j < n; ++j) {
      const std::int32_t px = column_x[j] + row_x, py = column_y[j] + row_y;
      const int x = px >> 16, y = py >> 16, fx = (px >> 9) & 127, fy = (py >> 9) & 127;
      const CropPixel a = pixel_at(picture, y, x, outside), b = pixel_at(picture, y, x + 1, outside);
      const CropPixel c = pixel_at(picture, y + 1, x, outside), d = pixel_at(picture, y + 1, x + 1, outside);
      const auto mix = [&](int pa, int pb, int pc, int pd) {
        const int upper = (128 - fx) * pa + fx * pb, lower = (128 - fx) * pc + fx * pd;
        return static_cast<std::int16_t>((((128 - fy) * upper + fy * lower + 64) >> 7) + offset);
      };
      std::int16_t* to = out.pixel(i, j);
      to[0] = mix(a.r, b.r, c.r, d.r);
      to[1] = mix(a.g, b.g, c.g, d.g);
      to[2] = mix(a.b, b.b, c.b, d.b);
    }
  }
}

}  // namespace

void ref::crop_square16(View<const Rgb8> picture, const TurnedSquare& region, Outside outside, int offset, Tensor16 y) {
  DUO_CHECK(y.channels() == 3 && y.width() == y.height() && y.width() <= kMostSide && !picture.empty());
  crop_rows(picture, region, outside, offset, y, 0, y.height());
}

// Neighbours lie anywhere: the plain rows on all threads.
void simd::crop_square16(Pool& pool, View<const Rgb8> picture, const TurnedSquare& region, Outside outside, int offset,
                         Tensor16 y) {
  DUO_CHECK(y.channels() == 3 && y.width() == y.height() && y.width() <= kMostSide && !picture.empty());
  pool.rows(y.height(), [&](int begin, int end) { crop_rows(picture, region, outside, offset, y, begin, end); });
}

}  // namespace duo
