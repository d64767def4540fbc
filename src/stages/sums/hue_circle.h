// Sine and cosine of hues, for means around the circle.
#pragma once

#include <array>
#include <cstdint>

namespace duo {

/// round(16384 sin(2 pi i / 256)) for a quarter of the circle.
inline constexpr std::array<std::int16_t, 65> kQuarterSine_q14 = {
#include "stages/sums/quarter_sine.inc"
};

constexpr int hue_sin_q14(int hue) {
  const int in_half = hue & 127;
  const int sine = kQuarterSine_q14[static_cast<std::size_t>(in_half <= 64 ? in_half : 128 - in_half)];
  return (hue & 128) != 0 ? -sine : sine;
}
constexpr int hue_cos_q14(int hue) { return hue_sin_q14(hue + 64); }

}  // namespace duo
