#include <algorithm>

#include "core/check.h"
#include "duoptic/paint.h"

namespace duo {

Image<Rgb8> side_by_side(std::span<const View<const Rgb8>> pictures) {
  Size size;
  for (const auto& p : pictures) size = {size.width + p.width(), std::max(size.height, p.height())};
  Image<Rgb8> out(size);
  int left = 0;
  for (const auto& p : pictures) {
    for (int y = 0; y < p.height(); ++y) std::copy_n(p.row(y), p.width(), out.row(y) + left);
    left += p.width();
  }
  return out;
}

Image<Rgb8> draw_rectified(const Frame& frame) {
  DUO_CHECK(frame.left.size() == frame.right.size());
  Image<Rgb8> out({2 * frame.left.width(), frame.left.height()});
  for (int y = 0; y < out.height(); ++y)
    for (int x = 0; x < frame.left.width(); ++x) {
      const std::uint8_t l = frame.left.at(y, x), r = frame.right.at(y, x);
      out.at(y, x) = {l, l, l};
      out.at(y, frame.left.width() + x) = {r, r, r};
    }
  return out;
}

}  // namespace duo
