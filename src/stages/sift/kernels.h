// What the two engines of SIFT do differently: five loops over pixels. Everything between them is in sift.cpp, once.
#pragma once

#include <cstdint>

#include "core/pool.h"
#include "stages/sift/sift.h"

namespace duo::sift {

constexpr int kMostRadius = 16;  // of a blur, px; the widest is 12

/// Half of a symmetric kernel: weight[0] is the centre.
struct BlurKernel {
  int radius;
  float weight[kMostRadius + 1];
};
BlurKernel blur_of_picture();                      // from the picture to level 0
BlurKernel blur_to(int level);                     // from the level below
float least_difference(const SiftParams& params);  // of an extremum, gray levels

constexpr int kDirections = 36;                 // of the orientation histogram
constexpr int kCells = 4, kCellDirections = 8;  // of the descriptor
constexpr int kBins = kCells + 2;               // with one cell around, which is thrown away
constexpr int kMostReach = 48;                  // px around a point that is looked at; the most is 40
constexpr float kFixed = 4096;                  // histogram units a gray level

/// The square of samples around a point and their Gaussian weights, along x and y alike: weight(x, y) = x_weight * y_weight.
struct Neighbourhood {
  int x_begin, x_end, y_begin, y_end;   // inside the octave, its outermost pixels left out
  float x, y;                           // of the point, px
  float x_weight[2 * kMostReach + 16];  // [i] belongs to x_begin + i; 16 more, so that whole vectors may be read
  float y_weight[2 * kMostReach + 16];  // times kFixed
};

/// From pixels around the point to cells of the descriptor: cell = turn * offset_px + centre.
struct CellFrame {
  float cos, sin;  // divided by the cell's width in px
  float turns;     // orientation
};

struct Gradient {
  View<const float> magnitude, turns;  // length in gray levels a 2 px; direction in [0, 1], from x right towards y down
};

struct Kernels {
  /// Rows [begin, end) of dst = src blurred down, then along; difference = dst - src, unless empty.
  void (*blur)(View<const float> src, const BlurKernel& kernel, View<float> dst, View<float> difference, int begin, int end);
  /// marks = 1 where |differences[1]| > threshold and none of the 26 neighbours exceeds it, in columns [x_begin, x_end).
  void (*mark)(const View<const float> (&differences)[3], float threshold, View<std::uint8_t> marks, int x_begin, int x_end,
               int begin, int end);
  /// Rows [begin, end), from central differences; x is 1 .. W - 2 (others are not used).
  void (*gradient)(View<const float> src, View<float> magnitude, View<float> turns, int begin, int end);
  /// Adds weight * magnitude to the nearest of kDirections.
  void (*directions)(const Gradient& gradient, const Neighbourhood& around, std::int32_t* histogram);
  /// Adds to [row][column][direction] of kBins x kBins x kCellDirections.
  void (*cells)(const Gradient& gradient, const Neighbourhood& around, const CellFrame& frame, std::int32_t* histogram);
};

/// The stage over either engine's loops.
void run(const Kernels& kernels, Pool& pool, View<const std::uint8_t> src, const Window& window, const SiftParams& params,
         SiftScratch& scratch, SiftPoints& out);

constexpr int kBorder = 5;           // px of an octave without extrema
constexpr int kSmallestOctave = 12;  // px; below, its border covers it

struct Pixel {
  int level, y, x;
  friend bool operator==(const Pixel&, const Pixel&) = default;
};

/// The extremum of the quadratic through the neighbours of `at`, which moves to the pixel nearest to it; false when it runs
/// away, is weak or lies on an edge.
bool refine(const View<const float> (&differences)[SiftScratch::kLevels + 2], const SiftParams& params, Pixel& at,
            SiftScratch::Place& place);

/// Directions of a place from its histogram.
void find_angles(const std::int32_t* histogram, SiftScratch::Place& place);

/// 128 bytes from the histogram of cells.
void normalize(const std::int32_t* histogram, std::uint8_t* descriptor);

}  // namespace duo::sift
