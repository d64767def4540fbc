#include "duoptic/picture_figures.h"

#include <cmath>
#include <vector>

#include "core/check.h"

namespace duo {

PictureFigures picture_figures(View<const Rgb8> picture) {
  const int width = picture.width(), height = picture.height();
  DUO_CHECK(width >= 3 && height >= 3);
  constexpr int kWhite = 250;
  std::vector<int> gray(static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
  double sum = 0, squares = 0, white = 0;
  std::size_t at = 0;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x, ++at) {
      const Rgb8 c = picture.at(y, x);
      const int value = (77 * c.r + 150 * c.g + 29 * c.b) >> 8;  // BT.601's weights
      gray[at] = value;
      sum += value, squares += value * value, white += value >= kWhite;
    }
  double bent = 0;
  for (int y = 1; y + 1 < height; ++y) {
    const int* row = gray.data() + static_cast<std::ptrdiff_t>(y) * width;
    for (int x = 1; x + 1 < width; ++x) {
      const int laplacian = row[x - 1] + row[x + 1] + row[x - width] + row[x + width] - 4 * row[x];
      bent += laplacian * laplacian;
    }
  }
  const double pixels = static_cast<double>(gray.size()), inner = static_cast<double>(width - 2) * (height - 2);
  const double variance = squares / pixels - sum / pixels * (sum / pixels);
  return {.focus = variance > 1e-9 ? 100 * std::sqrt(bent / inner / variance) : 0,
          .brightness_percent = 100 * sum / pixels / 255,
          .white_percent = 100 * white / pixels};
}

}  // namespace duo
