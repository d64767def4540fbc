// SIFT: points that are found again after the picture moved, turned, grew or changed its light.
#pragma once

#include <cstdint>
#include <vector>

#include "core/area.h"
#include "core/pool.h"
#include "duoptic/image.h"
#include "stages/types/sift_points.h"

namespace duo {

struct SiftParams {
  float contrast = 0.04f;  // least contrast of a point, three times as a share of the gray range
  float edge = 10;         // largest ratio of the two curvatures
  int octaves = 5;         // at most; the window may allow fewer
  int margin_px = 32;      // real pixels used around the window, where the picture has them
};

/// Planes of the largest window with its margin and lists of the largest count; reused by every octave and call.
class SiftScratch {
 public:
  static constexpr int kLevels = 3;      // an octave
  static constexpr int kMostAngles = 4;  // a place
  SiftScratch(Size largest_window, int capacity, const SiftParams& params = {});

  /// A refined extremum of the current octave, in its pixels.
  struct Place {
    float x, y, scale, response;
    std::uint8_t level;  // 1 .. kLevels
    std::uint8_t angles;
    float turns[kMostAngles];  // angles as shares of a full turn
  };
  Image<float> blurred[kLevels + 3], difference[kLevels + 2];
  Image<float> magnitude[kLevels], turns[kLevels];  // of the gradient at levels 1 .. kLevels
  Image<std::uint8_t> marks[kLevels];               // 1 at extrema
  std::vector<Place> places;                        // of the current octave
};

// Scale space, extrema with refinement, orientation and descriptor of one window, without doubling the picture first.
//
// Blurs: sigma 1.6 px * 2^(level / 3), the picture counted as blurred by 0.5 px; kernels end at 4 sigma. The next octave takes
// every second pixel of level 3; columns and rows that are multiples of 2^octave of the *picture*, so that the same place gives
// the same point from any window that holds it with enough margin.
// Extrema: not exceeded by any of 26 neighbours, 5 px away from the border of the octave. Refined by at most five Newton steps;
// weak ones and edges are dropped.
// Orientation: 36 directions, Gaussian of 1.5 scales, smoothed twice by 1 2 1; every peak of at least 0.8 of the highest gives
// one point, at most four.
// Descriptor: 4x4 cells of 3 scales, 8 directions, trilinear; length 1, clamped at 0.2, length 1 again, times 512, at most 255.
//
// Shape    the part of window inside src no larger than the scratch was made for; points lie in it
// Order    by (octave, level, y, x) of the extremum's pixel, then by angle
// Units    points in px of src
// Border   src continues by its edge pixels; so does the window beyond its margin, which changes coarse octaves near its border
// Threads  rows and points are independent; the result does not depend on them
// Exact    ref and simd agree bit for bit: floats are added in one order a pixel, histograms are integers (1/4096 gray levels:
//          a cell of 11 px squared with gradients of 361 stays below 2^28);
//          vk nearly always has the same bits: see sift_vk.h
// Errors   points beyond out.capacity() are dropped, last first, and counted in out.overflow (a place of which not even the
//          angles are known counts once)
// Source   Lowe, "Distinctive image features from scale-invariant keypoints", 2004
namespace ref {
void sift(View<const std::uint8_t> src, const Window& window, const SiftParams& params, SiftPoints& out);
}
namespace simd {
void sift(Pool& pool, View<const std::uint8_t> src, const Window& window, const SiftParams& params, SiftScratch& scratch,
          SiftPoints& out);
}

}  // namespace duo
