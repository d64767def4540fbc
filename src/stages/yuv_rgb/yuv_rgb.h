// Decoded JPEG pictures to colour: brightness in full range, chroma of half the width.
#pragma once

#include <cstdint>

#include "duoptic/image.h"

namespace duo {

/// Planes as decoders give them.
///
/// Shape  luma H x W, both even, no less than kLeast; chroma H/2 x W/2 (4:2:0) or H x W/2 (4:2:2)
struct YuvPlanes {
  static constexpr int kLeast = 16;
  View<const std::uint8_t> y, u, v;
  bool well_shaped() const {
    const Size all = y.size(), half{all.width / 2, all.height / 2};
    return all.width % 2 == 0 && all.height % 2 == 0 && all.width >= kLeast && all.height >= kLeast && u.size() == v.size() &&
           u.width() == half.width && (u.height() == half.height || u.height() == all.height);
  }
};

/// What chroma adds to colours, in 1/8192. BT.601's, in full range: 11485, -2819, -5850, 14516.
struct YuvWeights {
  std::int16_t red_of_v = 0, green_of_u = 0, green_of_v = 0, blue_of_u = 0;
};

// Chroma between two samples: 3 parts of the nearer and 1 of the farther one along rows; along columns of 4:2:0 the row above
// and this one have equal parts in even rows and in the last, this one alone in the others. A sum of 8 samples, less 8 * 128,
// times the weight is added to the brightness, rounded once and clipped to 0 .. 255.
//
// Border   samples continue by those at the edge
// Threads  one
// Exact    ref and simd agree bit for bit with libswscale's full, accurate and bit-exact bilinear conversion to RGB24, so that
//          a picture is the same whichever of them made it: what fits 16 bits here takes 32 there, a pixel at a time
// Source   libswscale's conversion for one row of brightness and two of chroma, as observed; ITU-R BT.601
namespace ref {
void yuv_rgb(const YuvPlanes& src, const YuvWeights& weights, View<Rgb8> dst);
}
namespace simd {
/// Rows of chroma on their way, of pictures of one width.
struct YuvScratch {
  explicit YuvScratch(int width);
  int width;
  Image<std::int16_t> u, v;
};
void yuv_rgb(const YuvPlanes& src, const YuvWeights& weights, YuvScratch& scratch, View<Rgb8> dst);
}  // namespace simd

/// The rows of chroma that row y of the picture takes.
struct ChromaRows {
  int first, second;
};
inline ChromaRows chroma_rows(const YuvPlanes& src, int y) {
  if (src.u.height() == src.y.height()) return {y, y};
  const int here = y / 2;
  const bool both = (y % 2 == 0 && y > 0) || y == src.y.height() - 1;
  return {both ? here - 1 : here, here};
}

}  // namespace duo
