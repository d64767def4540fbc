#include "trackers/body/filled_margin.h"

#include <algorithm>

#include "core/check.h"

namespace duo::body {

FilledMargin::FilledMargin(const Rectified& rectified, const Lens& left) : mask_(rectified.size), filled_(rectified.size) {
  constexpr double kEdge_px = 0.75;  // the last pixels are mixed with black
  const int width = rectified.size.width, height = rectified.size.height;
  const Mat3 left_from_rig = transposed(rectified.rig_from_left);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const auto pixel = left.pixel_of(left_from_rig * rectified.unproject({double(x), double(y)}, 1));
      mask_.at(y, x) = pixel && left.covers(*pixel, -kEdge_px) ? 0 : 1;
    }
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      if (mask_.at(y, x) == 0) continue;
      for (int away = 1; away < std::max(width, height); ++away) {
        const auto sees = [&](int from_x, int from_y) {
          if (from_x < 0 || from_y < 0 || from_x >= width || from_y >= height || mask_.at(from_y, from_x) != 0) return false;
          margin_.push_back({x, y, from_x, from_y});
          return true;
        };
        if (sees(x, y - away) || sees(x, y + away) || sees(x - away, y) || sees(x + away, y)) break;
      }
    }
}

View<const Rgb8> FilledMargin::fill(View<const Rgb8> picture) {
  if (margin_.empty()) return picture;
  DUO_CHECK(picture.size() == filled_.size());
  for (int y = 0; y < picture.height(); ++y) std::copy_n(picture.row(y), picture.width(), filled_.row(y));
  for (const Repeated& p : margin_) filled_.at(p.y, p.x) = picture.at(p.from_y, p.from_x);
  return filled_;
}

}  // namespace duo::body
