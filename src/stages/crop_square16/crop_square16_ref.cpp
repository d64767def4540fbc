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

/// Where the columns and rows of the square lie, 1/65536 px: a pixel's place is the sum of both.
class CropGrid {
 public:
  CropGrid(const TurnedSquare& region, int side) : region_(region), side_(side) {
    for (int j = 0; j < side; ++j) {
      const std::int64_t k = 256 * (2 * j + 1 - side);
      column_x_[j] = 256 * region.x_q8 + static_cast<std::int32_t>(floor_quotient(k * region.right_x_q8, side));
      column_y_[j] = 256 * region.y_q8 + static_cast<std::int32_t>(floor_quotient(k * region.right_y_q8, side));
    }
  }
  void set_row(int i) {
    const std::int64_t l = 256 * (2 * i + 1 - side_);
    row_x_ = static_cast<std::int32_t>(floor_quotient(-l * region_.right_y_q8, side_));
    row_y_ = static_cast<std::int32_t>(floor_quotient(l * region_.right_x_q8, side_));
  }
  std::int32_t x(int j) const { return column_x_[j] + row_x_; }
  std::int32_t y(int j) const { return column_y_[j] + row_y_; }

 private:
  TurnedSquare region_;
  int side_;
  std::int32_t row_x_ = 0, row_y_ = 0;
  std::array<std::int32_t, kMostSide> column_x_, column_y_;
};

std::int16_t bilinear(int a, int b, int c, int d, int fx, int fy, int offset) {
  const int upper = (128 - fx) * a + fx * b, lower = (128 - fx) * c + fx * d;
  return static_cast<std::int16_t>((((128 - fy) * upper + fy * lower + 64) >> 7) + offset);
}

/// One pixel anywhere.
void crop_pixel(View<const Rgb8> picture, std::int32_t px, std::int32_t py, Outside outside, int offset, std::int16_t* to) {
  const int x = px >> 16, y = py >> 16, fx = (px >> 9) & 127, fy = (py >> 9) & 127;
  const CropPixel a = pixel_at(picture, y, x, outside), b = pixel_at(picture, y, x + 1, outside);
  const CropPixel c = pixel_at(picture, y + 1, x, outside), d = pixel_at(picture, y + 1, x + 1, outside);
  to[0] = bilinear(a.r, b.r, c.r, d.r, fx, fy, offset);
  to[1] = bilinear(a.g, b.g, c.g, d.g, fx, fy, offset);
  to[2] = bilinear(a.b, b.b, c.b, d.b, fx, fy, offset);
}

/// One whose four neighbours all lie in the picture.
void crop_inner_pixel(View<const Rgb8> picture, std::int32_t px, std::int32_t py, int offset, std::int16_t* to) {
  const int fx = (px >> 9) & 127, fy = (py >> 9) & 127;
  const Rgb8* upper = picture.row(py >> 16) + (px >> 16);
  const Rgb8* lower = upper + picture.stride();
  to[0] = bilinear(upper[0].r, upper[1].r, lower[0].r, lower[1].r, fx, fy, offset);
  to[1] = bilinear(upper[0].g, upper[1].g, lower[0].g, lower[1].g, fx, fy, offset);
  to[2] = bilinear(upper[0].b, upper[1].b, lower[0].b, lower[1].b, fx, fy, offset);
}

void check_sizes(View<const Rgb8> picture, Tensor16 y) {
  DUO_CHECK(y.channels() == 3 && y.width() == y.height() && y.width() <= kMostSide && !picture.empty());
}

}  // namespace

void ref::crop_square16(View<const Rgb8> picture, const TurnedSquare& region, Outside outside, int offset, Tensor16 y) {
  check_sizes(picture, y);
  CropGrid grid(region, y.width());
  for (int i = 0; i < y.height(); ++i) {
    grid.set_row(i);
    for (int j = 0; j < y.width(); ++j) crop_pixel(picture, grid.x(j), grid.y(j), outside, offset, y.pixel(i, j));
  }
}

// Neighbours lie anywhere, so that lanes do not pay; but a row whose ends lie inside lies inside as a whole.
void simd::crop_square16(Pool& pool, View<const Rgb8> picture, const TurnedSquare& region, Outside outside, int offset,
                         Tensor16 y) {
  check_sizes(picture, y);
  const int last = y.width() - 1;
  pool.rows(y.height(), [&](int begin, int end) {
    CropGrid grid(region, y.width());
    const auto inside = [&](int j) {
      const int px = grid.x(j) >> 16, py = grid.y(j) >> 16;
      return px >= 0 && px < picture.width() - 1 && py >= 0 && py < picture.height() - 1;
    };
    for (int i = begin; i < end; ++i) {
      grid.set_row(i);
      if (inside(0) && inside(last))
        for (int j = 0; j <= last; ++j) crop_inner_pixel(picture, grid.x(j), grid.y(j), offset, y.pixel(i, j));
      else
        for (int j = 0; j <= last; ++j) crop_pixel(picture, grid.x(j), grid.y(j), outside, offset, y.pixel(i, j));
    }
  });
}

}  // namespace duo
