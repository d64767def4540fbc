#include <algorithm>

#include "core/check.h"
#include "stages/hsv/hsv.h"

namespace duo::ref {

void hsv(View<const Rgb8> src, const HsvPlanes& dst) {
  DUO_CHECK(src.size() == dst.hue.size() && src.size() == dst.saturation.size() && src.size() == dst.value.size());
  for (int y = 0; y < src.height(); ++y)
    for (int x = 0; x < src.width(); ++x) {
      const auto [r, g, b] = src.at(y, x);
      const int largest = std::max({r, g, b}), chroma = largest - std::min({r, g, b});
      int hue = 0;
      if (chroma > 0) {
        int sixths = 0;  // of the circle, in units of 1 / chroma
        if (r == largest)
          sixths = g >= b ? g - b : g - b + 6 * chroma;
        else if (g == largest)
          sixths = b - r + 2 * chroma;
        else
          sixths = r - g + 4 * chroma;
        hue = (256 * sixths + 3 * chroma) / (6 * chroma) % 256;
      }
      dst.hue.at(y, x) = static_cast<std::uint8_t>(hue);
      dst.saturation.at(y, x) = static_cast<std::uint8_t>(largest > 0 ? (510 * chroma + largest) / (2 * largest) : 0);
      dst.value.at(y, x) = static_cast<std::uint8_t>(largest);
    }
}

}  // namespace duo::ref
