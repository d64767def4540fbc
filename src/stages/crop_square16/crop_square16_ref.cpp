#include <algorithm>

#include "core/check.h"
#include "stages/crop_square16/crop_grid.h"
#include "stages/crop_square16/crop_square16.h"

namespace duo {
namespace {

struct CropPixel {
  int r, g, b;
};

CropPixel pixel_at(View<const Rgb8> picture, int y, int x, Outside outside) {
  if (outside == Outside::kBlack && (y < 0 || y >= picture.height() || x < 0 || x >= picture.width())) return {0, 0, 0};
  const Rgb8 p = picture.at(std::clamp(y, 0, picture.height() - 1), std::clamp(x, 0, picture.width() - 1));
  return {p.r, p.g, p.b};
}

std::int16_t bilinear(int a, int b, int c, int d, int fx, int fy, int offset) {
  const int upper = (128 - fx) * a + fx * b, lower = (128 - fx) * c + fx * d;
  return static_cast<std::int16_t>((((128 - fy) * upper + fy * lower + 64) >> 7) + offset);
}

void crop_pixel(View<const Rgb8> picture, std::int32_t px, std::int32_t py, Outside outside, int offset, std::int16_t* to) {
  const int x = px >> 16, y = py >> 16, fx = (px >> 9) & 127, fy = (py >> 9) & 127;
  const CropPixel a = pixel_at(picture, y, x, outside), b = pixel_at(picture, y, x + 1, outside);
  const CropPixel c = pixel_at(picture, y + 1, x, outside), d = pixel_at(picture, y + 1, x + 1, outside);
  to[0] = bilinear(a.r, b.r, c.r, d.r, fx, fy, offset);
  to[1] = bilinear(a.g, b.g, c.g, d.g, fx, fy, offset);
  to[2] = bilinear(a.b, b.b, c.b, d.b, fx, fy, offset);
}

}  // namespace

void ref::crop_square16(View<const Rgb8> picture, const TurnedSquare& region, Outside outside, int offset, Tensor16 y) {
  DUO_CHECK(y.channels() == 3 && y.width() == y.height() && y.width() <= CropGrid::kMostSide && !picture.empty());
  CropGrid grid(region, y.width());
  for (int i = 0; i < y.height(); ++i) {
    grid.set_row(i);
    for (int j = 0; j < y.width(); ++j) crop_pixel(picture, grid.x(j), grid.y(j), outside, offset, y.pixel(i, j));
  }
}

}  // namespace duo
