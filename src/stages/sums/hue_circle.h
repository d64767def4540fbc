// Sine and cosine of hues, for means around the circle.
#pragma once

#include <array>
#include <cstdint>

namespace duo {

/// round(16384 sin(2 pi i / 256)) for a quarter of the circle.
inline constexpr std::array<std::int16_t, 65> kQuarterSine_q14 = {
    0,     402,   804,   1205,  1606,  2006,  2404,  2801,  3196,  3590,  3981,  4370,  4756,  5139,  5520,  5897,  6270,
    6639,  7005,  7366,  7723,  8076,  8423,  8765,  9102,  9434,  9760,  10080, 10394, 10702, 11003, 11297, 11585, 11866,
    12140, 12406, 12665, 12916, 13160, 13395, 13623, 13842, 14053, 14256, 14449, 14635, 14811, 14978, 15137, 15286, 15426,
    15557, 15679, 15791, 15893, 15986, 16069, 16143, 16207, 16261, 16305, 16340, 16364, 16379, 16384};

constexpr int hue_sin_q14(int hue) {
  const int in_half = hue & 127;
  const int sine = kQuarterSine_q14[static_cast<std::size_t>(in_half <= 64 ? in_half : 128 - in_half)];
  return (hue & 128) != 0 ? -sine : sine;
}
constexpr int hue_cos_q14(int hue) { return hue_sin_q14(hue + 64); }

}  // namespace duo
