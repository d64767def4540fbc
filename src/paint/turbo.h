// The Turbo colour map.
#pragma once

#include <algorithm>
#include <cmath>

#include "duoptic/image.h"

namespace duo {

/// Colour of `t` in 0 (dark blue) .. 1 (dark red).
///
/// Source  Mikhailov, "Turbo, an improved rainbow colormap for visualization", 2019; the published fifth-order polynomials
inline Rgb8 turbo(double t) {
  t = std::clamp(t, 0.0, 1.0);
  const auto channel = [t](double a0, double a1, double a2, double a3, double a4, double a5) {
    const double v = a0 + t * (a1 + t * (a2 + t * (a3 + t * (a4 + t * a5))));
    return static_cast<std::uint8_t>(std::lround(255 * std::clamp(v, 0.0, 1.0)));
  };
  return {channel(0.13572138, 4.61539260, -42.66032258, 132.13108234, -152.94239396, 59.28637943),
          channel(0.09140261, 2.19418839, 4.84296658, -14.18503333, 4.27729857, 2.82956604),
          channel(0.10667330, 12.64194608, -60.58204836, 110.36276771, -89.90310912, 27.34824973)};
}

}  // namespace duo
