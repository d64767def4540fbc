#include <algorithm>
#include <array>
#include <cmath>

#include "core/check.h"
#include "duoptic/paint.h"
#include "paint/hue.h"
#include "stages/hsv/hsv.h"

namespace duo {

Rgb8 color_of_hue(int hue) {
  // Trapezoids over the circle, each a third of it apart from the next.
  const auto channel = [hue](int center) {
    const int around = (hue - center + 384) & 255;  // 128 at the centre
    return static_cast<std::uint8_t>(std::clamp(510 - std::abs(around - 128) * 6, 0, 255));
  };
  return {channel(0), channel(85), channel(171)};
}

void draw_hue(View<const Rgb8> src, View<Rgb8> dst) {
  DUO_CHECK(src.size() == dst.size());
  Image<std::uint8_t> hue(src.size()), saturation(src.size()), value(src.size());
  ref::hsv(src, {hue, saturation, value});
  std::array<Rgb8, 256> colors;
  std::array<int, 256> brightness;  // 0 .. 256; a root, because skin and cloth have little saturation
  for (int i = 0; i < 256; ++i) {
    colors[static_cast<std::size_t>(i)] = color_of_hue(i);
    brightness[static_cast<std::size_t>(i)] = static_cast<int>(std::lround(256 * std::sqrt(i / 255.0)));
  }
  for (int y = 0; y < dst.height(); ++y)
    for (int x = 0; x < dst.width(); ++x) {
      const Rgb8 c = colors[hue.at(y, x)];
      const int b = brightness[saturation.at(y, x)];
      dst.at(y, x) = {static_cast<std::uint8_t>(c.r * b >> 8), static_cast<std::uint8_t>(c.g * b >> 8),
                      static_cast<std::uint8_t>(c.b * b >> 8)};
    }
}

Image<Rgb8> hue_strip() {
  Image<Rgb8> out({256, 1});
  for (int x = 0; x < out.width(); ++x) out.at(0, x) = color_of_hue(x);
  return out;
}

}  // namespace duo
