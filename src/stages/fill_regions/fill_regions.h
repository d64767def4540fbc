// Fills flat walls by planes: between the texture at a wall's rim there is nothing to match, and little that it could be.
#pragma once

#include <cstdint>
#include <vector>

#include "core/pool.h"
#include "duoptic/frame.h"
#include "stages/fill_regions/region_plane.h"
#include "stages/types/run_forest.h"

namespace duo {

/// Holes in a flat region of the picture take the region's plane; they are marked Origin::kFilled.
///
/// Flat: both sums of the 3x3 Sobel operator are at most kFlatGradient. Region: flat pixels joined (4-connected) by steps of at
/// most kFlatStep gray levels, kFewestPixels of them or more, at least a tenth without a disparity. Its plane is that of
/// region_plane(), through the measured pixels that have the region, without a larger step, in all of 8 columns to both sides,
/// and in 2 rows above and below, in reading order: at a rim disparities belong to what stands before the wall. A region whose
/// points do not agree on a plane stays as it is, and so do holes for which the plane is outside 0 .. max_disparity - 1.
///
/// Shape    gray, d_q4 and origin H x W, the latter two changed in place; origin is kNone exactly where d_q4 is none
/// Units    1/16 px
/// Border   edge pixels continue
/// Threads  rows, and then regions, are independent; of a simd version only the flat pixels are vectors
/// Exact    ref and simd agree bit for bit: both find a region's plane by the same function, and all else is integers
/// Source   planes of colour segments as in Klaus, Sormann, Karner, "Segment-based stereo matching using belief propagation and
/// a
///          self-adapting dissimilarity measure", 2006; here of flat regions, and of holes alone
struct FillRegions {
  static constexpr int kFlatGradient = 8, kFlatStep = 2, kFewestPixels = 400, kHolesOf = 10, kInnerColumns = 8, kInnerRows = 2;

  View<const std::uint8_t> gray;
  int max_disparity = 0;
};

namespace ref {
void fill_regions(const FillRegions& in, View<std::uint16_t> d_q4, View<std::uint8_t> origin);
}

namespace simd {
class FillRegionsScratch {
 public:
  explicit FillRegionsScratch(Size size);

  struct Region {
    int pixels = 0, holes = 0;
    std::size_t first = 0, points = 0;  // of the inner points
    RegionPlane plane = {};
    bool fills = false;
  };
  Image<std::uint8_t> flat;  // 0 or 1
  RunForestScratch runs;
  Image<std::int32_t> region;  // of each pixel of a region that is large enough: its number from 1; else 0
  std::vector<Region> regions;
  std::vector<PlanePoint> points;  // those of one region after those of another
};
void fill_regions(Pool& pool, const FillRegions& in, FillRegionsScratch& scratch, View<std::uint16_t> d_q4,
                  View<std::uint8_t> origin);
}  // namespace simd

}  // namespace duo
