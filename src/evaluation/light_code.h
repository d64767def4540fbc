// What the patterns of structured light tell of one pixel, and how the views of both cameras are compared.
#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "core/pool.h"
#include "duoptic/structured_light.h"

namespace duo {

/// Gray code: neighbouring numbers differ in one bit.
///
/// Source  Gray, "Pulse code communication", US patent 2632058, 1953
constexpr std::uint32_t gray_of(std::uint32_t number) { return number ^ number >> 1; }
constexpr std::uint32_t number_of_gray(std::uint32_t gray) {
  for (int shift = 16; shift > 0; shift /= 2) gray ^= gray >> shift;
  return gray;
}

/// Bits of the Gray code that counts all stripes of an axis.
int gray_bits(const LightCode& code, bool rows);

/// Where the sine of a step begins, in eighths of a turn: each step is far from the one before, so that it can be told when
/// the picture has changed.
constexpr int eighths_of_step(int step) { return 3 * step % kPhaseSteps; }
constexpr double turns_of_step(int step) { return eighths_of_step(step) / double{kPhaseSteps}; }

/// Brightness as decoding sees it: red, twice green and blue together; kSaturated where a channel is near its end.
constexpr std::uint16_t kSaturated = 0xFFFF;
constexpr int kLastLevel = 250;  // JPEG takes some levels from a channel at its end, and so do pixels that are mixed with it
constexpr std::uint16_t brightness_of(Rgb8 c) {
  return c.r >= kLastLevel || c.g >= kLastLevel || c.b >= kLastLevel ? kSaturated
                                                                     : static_cast<std::uint16_t>(c.r + 2 * c.g + c.b);
}

enum class LightState : std::uint8_t { kOutside, kUnlit, kSaturated, kUncertain, kKnown };

/// A pixel's place along one axis of the projector.
///
/// Units  place in 1/256 px, 0 at the edge of the screen, so that the middle of its first pixel is 128; amplitude of the sine
///        as brightness_of()
struct PlaceOnAxis {
  LightState state = LightState::kOutside;
  std::int32_t place_q8 = -1;
  int amplitude = 0;
};

/// samples  of the axis's patterns in their order: each bit and its inverse, then the sine's steps
/// noise    standard deviation of a sample; what is below six of them is unlit
PlaceOnAxis place_on_axis(std::span<const std::uint16_t> samples, int period_px, int length_px, double noise);

/// The variance of a sample by what eight steps of a sine cannot hold: its third and fourth harmonics. Saturated: none.
std::optional<double> noise_variance(std::span<const std::uint16_t> steps);

/// One view: of each pixel its place on the projector in 1/256 px, -1 where it is not known.
struct ViewPlaces {
  Image<std::int32_t> x_q8, y_q8;
};

/// Places averaged over 3x3 pixels of one surface: always two that lie opposite each other, so that a slant changes nothing.
/// Where a surface's colour changes within a pixel its place is that of the brighter part; averaged, both views see this alike.
/// A pixel that agrees with no such two lies on an edge, sees two surfaces, and becomes unknown, as the picture's border does.
ViewPlaces averaged_places(Pool& pool, const ViewPlaces& view, const LightCode& code);

/// Where the row of the other view has the place that a pixel has, between two of its pixels.
struct RowMatch {
  double x_px = 0;
  std::int32_t y_q8 = 0;  // the projector's row there: that of the pixel, when rows agree
};

/// Of several the one whose row of the projector is nearest; none farther than `reach_q8` from it. Pixels side by side lie on
/// one surface when their places are not farther apart than that.
std::optional<RowMatch> find_on_row(const ViewPlaces& other, int y, int x_begin, int x_end, std::int32_t x_q8,
                                    std::int32_t y_q8, std::int32_t reach_q8);

struct ViewMatch {
  Image<float> disparity_px;  // of the left view; 0 = unknown
  std::int64_t matched = 0, contradicting = 0;
  double rows_px = 0;  // see LightTruth
};

/// Each left pixel's match in the right view, where the right view's match of that place leads back to within a pixel.
ViewMatch match_views(Pool& pool, const ViewPlaces& left, const ViewPlaces& right, const LightCode& code);

}  // namespace duo
