// What the tracker tells the engine to look for (part of its Expectation) and what it gets back (part of the Observation):
// plain numbers, a few kB for all targets, so that they travel to and from a device as they are.
#pragma once

#include <array>
#include <cstdint>

#include "core/area.h"
#include "duoptic/frame.h"

namespace duo {

inline constexpr int kMaxTargets = 6;  // both arms: hand, elbow, shoulder; bit t of a mark belongs to target t

/// Hue and saturation in 32 x 32 bins of 8 x 8 levels; row by row, hue first.
inline constexpr int kColorBins = 32 * 32;
inline constexpr int color_bin(std::uint8_t hue, std::uint8_t saturation) { return (hue >> 3) * 32 + (saturation >> 3); }

using ColorHistogram = std::array<std::uint32_t, kColorBins>;
/// How much more likely a colour is the target's than its surroundings'; 255 = surely the target, 128 = as likely.
using ColorLikelihood = std::array<std::uint8_t, kColorBins>;

/// A pixel fits where saturation and value reach their minima, and either its hue lies within `hue_tolerance` of `hue` around
/// the circle, or, with a table (`likelihood` >= 0, an index), its bin there reaches `min_likelihood`.
///
/// Units   hue 256 = full circle; a tolerance of 128 takes every hue
struct ColorModel {
  std::uint8_t hue = 0, hue_tolerance = 128;
  std::uint8_t min_saturation = 0, min_value = 0;
  std::int16_t likelihood = -1;
  std::uint8_t min_likelihood = 128;
};

/// A pixel passes where its disparity lies in [min_q4, max_q4] and more than `background_tolerance_q4` from the background's,
/// where that is known and the tolerance not negative. Without disparity it passes if `pass_unknown`.
struct DepthGate {
  std::uint16_t min_q4 = 0, max_q4 = Disparity::kNone - 1;
  std::int32_t background_tolerance_q4 = -1;
  bool pass_unknown = true;
};

/// What one target looks like and where it can be.
struct Target {
  ColorModel color;
  DepthGate gate;
  Window window;
};

struct Pixel {
  std::int32_t y = -1, x = -1;  // -1: none
  bool found() const { return y >= 0; }
  friend bool operator==(const Pixel&, const Pixel&) = default;
};

/// A connected region: the row-major index of its first pixel, -1 = none, and how many it has.
struct RegionLabel {
  std::int32_t label = -1, pixels = 0;
  friend bool operator==(const RegionLabel&, const RegionLabel&) = default;
};

/// Sums over an area; means and axes follow without another look at the picture.
///
/// Units   pixels; d_q4 1/16 px over the `known` pixels that have a disparity; hue sums of the cosine and sine in 1/16384
struct AreaSums {
  std::int64_t count = 0, x = 0, y = 0, xx = 0, xy = 0, yy = 0;
  std::int64_t known = 0, d_q4 = 0;
  std::int64_t hue_cos_q14 = 0, hue_sin_q14 = 0;
  Pixel first = {}, last = {};  // upper left and lower right corner of the bounding box, both inside
  friend bool operator==(const AreaSums&, const AreaSums&) = default;
};

/// Order statistics of disparity over an area: of n known values in order, those at (n - 1) / 4, (n - 1) / 2 and 3 (n - 1) / 4.
///
/// Units   1/16 px; Disparity::kNone where known = 0
struct DepthSample {
  std::int32_t count = 0, known = 0;
  std::uint16_t lower_q4 = Disparity::kNone, median_q4 = Disparity::kNone, upper_q4 = Disparity::kNone;
  friend bool operator==(const DepthSample&, const DepthSample&) = default;
};

}  // namespace duo
