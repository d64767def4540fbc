// Undistort and rectify in one resampling pass, in fixed point so that every engine gives the same bits.
#pragma once

#include <array>
#include <cstdint>

#include "core/pool.h"
#include "duoptic/image.h"

namespace duo {

/// Where each pixel of the rectified picture lies in the raw one.
///
/// Shape   both H x W of the rectified picture
/// Units   corner: x0 << 16 | y0, the top-left of the four raw pixels, or kOutside; fraction_q8: fx << 8 | fy
///         0 <= x0 <= raw width - 2, 0 <= y0 <= raw height - 2 (so raw pictures are at least 2x2); where columns is not kLinear
///         y0 may be the last row, too
struct ResampleMap {
  /// How rows are combined. kSoft: a picture that stays where it is, so that the corner is the pixel itself, gets as much blur
  /// from the rows beside as kCubic has at the same fy.
  enum class Columns : std::uint8_t { kLinear, kCubic, kSoft };
  static constexpr std::uint32_t kOutside = 0xFFFFFFFF;
  Image<std::uint32_t> corner;
  Image<std::uint16_t> fraction_q8;
  Columns columns = Columns::kLinear;
};

/// Catmull-Rom's weights, in 1/256, of the row before a place, its row, and the two behind; the place is f/256 below its row.
constexpr std::array<int, 4> cubic_weights(int f) {
  const int f2 = f * f, f3 = f2 * f, half = 1 << 16;
  const int before = (-f3 + 512 * f2 - 65536 * f + half) >> 17, after = (-3 * f3 + 1024 * f2 + 65536 * f + half) >> 17;
  const int last = (f3 - 256 * f2 + half) >> 17;
  return {before, 256 - before - after - last, after, last};
}

/// Those of a row that stays where it is, blurred as cubic_weights(f) blur: of a wave of five pixels both leave the same, 0.95
/// of it half-way between rows, to a hundredth also elsewhere.
constexpr std::array<int, 4> soft_weights(int f) {
  const int whole = f * (256 - f) >> 2, beside = (10 * whole * whole + (1 << 23)) >> 24;
  return {beside, 256 - 2 * beside, beside, 0};
}

// Resampling through a map, bilinear, or linear along rows and cubic along columns: where a picture moves by a part of a row
// and nothing has smoothed it before, two rows' mean would blur it against the other one. What little the cubic blurs the other
// one is blurred, too, with kSoft.
//
// value = ((p00 (256-fx) + p01 fx) (256-fy) + (p10 (256-fx) + p11 fx) fy + 32768) >> 16, exact in 32 bits
// kCubic and kSoft: the same of the four rows y0 - 1 .. y0 + 2 with cubic_weights(fy) or soft_weights(fy), clipped to 0 .. 255;
// rows beyond the picture continue
//
// Shape    src is the raw picture; dst and inside have the map's size
// Units    inside: 255 where the raw picture covers the pixel, 0 outside (dst is 0 there; never match on it)
// Border   the map marks what is outside
// Threads  rows are independent
// Exact    ref, simd and vk agree bit for bit
// Source   one texture-coordinate transform per pixel, as in the thesis; bilinear with 8-bit weights; Catmull, Rom, "A class of
//          local interpolating splines", 1974
namespace ref {
void rectify(View<const std::uint8_t> src, const ResampleMap& map, View<std::uint8_t> dst, View<std::uint8_t> inside);
}
namespace simd {
void rectify(Pool& pool, View<const std::uint8_t> src, const ResampleMap& map, View<std::uint8_t> dst,
             View<std::uint8_t> inside);
/// Colour for display, for clouds and for weights of like colours, bilinear; a picture that stays where it is (kSoft) is
/// copied. Integers: every engine runs this one, with the same bits on every instruction set.
void rectify(Pool& pool, View<const Rgb8> src, const ResampleMap& map, View<Rgb8> dst);
}  // namespace simd

}  // namespace duo
