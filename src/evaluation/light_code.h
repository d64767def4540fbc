// What the patterns of structured light tell of one pixel, and how the views of both cameras are compared.
#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "core/pool.h"
#include "duoptic/structured_light.h"

namespace duo {

struct ResampleMap;

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

/// Places of a view's rectified pixels, and by how much they change from a column to the next.
///
/// Units  1/256 px; `at` -1 where it is not known
struct PlacePlanes {
  ViewPlaces at, step;
};

/// Of the windows of 5x5 raw pixels that hold the one nearest to a rectified pixel, the one whose places lie best on planes,
/// and the nearer the better, gives its places by least squares; where none of them does so, one of 3x3. So a pixel beside an
/// edge has the place of its own surface. One that sees two surfaces, whose place is that of neither, is in no such window and
/// becomes unknown. Where a surface's colour changes within a pixel its place is that of the brighter part; averaged, both
/// views see this alike.
///
/// map     from rectified pixels to raw ones; none: they are the same
/// Source  Nagao, Matsuyama, "Edge preserving smoothing", 1979: the best of several windows around a pixel
PlacePlanes place_planes(Pool& pool, const ViewPlaces& raw, const ResampleMap* map, const LightCode& code);

/// Where a row of the other view has the place that a pixel has.
struct RowMatch {
  int column = 0;         // in whose pixel it lies
  double x_px = 0;        // by this pixel's plane
  std::int32_t y_q8 = 0;  // the projector's row there: that of the pixel, when rows agree
};

/// Of several the one whose row of the projector is nearest; none farther than `reach_q8` from it, and none where a step from
/// column to column is farther than that.
std::optional<RowMatch> find_on_row(const PlacePlanes& other, int y, int x_begin, int x_end, std::int32_t x_q8,
                                    std::int32_t y_q8, std::int32_t reach_q8);

struct ViewMatch {
  Image<float> disparity_px;  // of the left view; 0 = unknown
  std::int64_t matched = 0, contradicting = 0;
  double rows_px = 0;  // see LightTruth
};

/// Each left pixel's match in the right view, where the right view's match of that place leads back to within a pixel.
ViewMatch match_views(Pool& pool, const PlacePlanes& left, const PlacePlanes& right, const LightCode& code);

}  // namespace duo
