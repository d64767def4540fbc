// Window matching where each tile of the picture has its own set of candidate disparities.
#pragma once

#include <cstdint>
#include <vector>

#include "core/pool.h"
#include "duoptic/frame.h"
#include "stages/types/gray_pair.h"
#include "stages/types/tile_sets.h"

namespace duo {

struct MatchTilesParams {
  int truncation = 12;  // of each channel; three channels and seven pixels stay below 256 up to 12
  int sobel_clip = 63;  // of the gradients, at most 63
  bool wide_shifts = true;
};

/// The best candidate of each pixel, for both views.
///
/// Channels: half the gray value, and both Sobel gradients clipped to +-sobel_clip, plus 128. Cost of one pixel: the sum over
/// the channels of min(difference, truncation), where a gradient's difference is its distance to the interval of the right
/// value and the half-way values towards its neighbours (x: left and right; y: all four). A pixel whose 3x3 neighbourhood is
/// not all inside its raw picture costs the most there is, against anything. Window: 7x7 sum of costs; then the least of the
/// windows moved by {-3, -1, 1, 3} x {-2, 0, 2} (`wide_shifts`) or
/// {-2, 0, 2} x {-2, 0, 2} whose centres lie in the picture. Candidates with x < d are not tried. The smallest d wins a tie.
/// The right view's best is the least of the same costs along x - d.
/// Sub-pixel: a V through the costs of d - 1, d, d + 1, rounded half away from zero; 0 where one of them was not tried.
///
/// Shape    all H x W
/// Units    left, right px, -1 = no candidate; fine 1/16 px, Disparity::kNone = no candidate
/// Border   channels continue by their edge pixels, for any d
/// Threads  bands of tiles are independent
/// Exact    ref, simd and vk agree bit for bit; window sums stay below 49 * 36 = 1764
/// Source   Birchfield, Tomasi 1998 (intervals); Bobick, Intille, "Large occlusion stereo", 1999 (shiftable windows); Sobel
///          channels after Hirschmueller's pre-filtered BT in common SGM practice; V-shaped sub-pixel: Haller, Nedevschi,
///          "Design of interpolation functions for subpixel-accuracy stereo-vision systems", 2012
struct TileMatch {
  View<std::int16_t> left, right;
  View<std::uint16_t> fine;
};

namespace ref {
void match_tiles(const GrayPair& pair, const TileSets& sets, const MatchTilesParams& params, const TileMatch& out);
}

namespace simd {
/// Channels with edges continued so far that the kernel never leaves a row, and each thread's tile of costs.
class MatchTilesScratch {
 public:
  MatchTilesScratch(Size size, int max_disparity, int threads);

  struct Channels {
    Image<std::uint8_t> gray, sobel_x, sobel_y;
  };
  struct Band {
    Image<std::int16_t> costs;       // [tile row][candidate][64]
    Image<std::int16_t> right_cost;  // best costs and disparities of the right view, rows of the band
    Image<std::int16_t> right;
    std::vector<std::int16_t> candidates;
  };
  int pad_left;  // columns before x = 0 in every channel and in the rows of Band
  Channels left, right;
  Image<std::uint8_t> sobel_x_low, sobel_x_high, sobel_y_low, sobel_y_high;  // of the right picture
  std::vector<Band> bands;                                                   // one a thread
};
void match_tiles(Pool& pool, const GrayPair& pair, const TileSets& sets, const MatchTilesParams& params,
                 MatchTilesScratch& scratch, const TileMatch& out);
}  // namespace simd

}  // namespace duo
