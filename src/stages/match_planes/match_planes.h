// Census and gradients: what semi-global matching compares two pixels by.
#pragma once

#include <cstdint>

#include "core/pool.h"
#include "stages/types/clear.h"
#include "stages/types/match_planes.h"

namespace duo {

/// Fills the planes of one view from its gray picture.
///
/// Census: 16 neighbours at kCensus, one bit each: darker than the pixel by more than `dead_zone`, which noise may stay within.
/// Channels: gray; Sobel x and y, a quarter of the 3x3 sum, rounded down, clipped to +-63, plus 128; of `clear` pictures, whose
/// small gradients are no noise, the whole sum, clipped to +-127, plus 128. Interval: least and greatest of the value and its
/// means with the left, right, upper and lower neighbour, halves rounded up; of the gray of clear pictures wider by
/// kClearGrayDeadZone at both ends, within 0 .. 255, as two cameras do not see a wall's brightness alike, and walls without
/// texture have little else. Outside: 255 where the 3x3 neighbourhood is not all inside its raw picture.
///
/// Units    dead_zone in gray levels, 0 .. 255
/// Shape    gray H x W; inside the same or empty = all inside; out made with this size
/// Border   edge pixels continue
/// Threads  rows are independent
/// Exact    ref, simd and vk agree bit for bit
/// Source   Zabih, Woodfill, "Non-parametric local transforms for computing visual correspondence", 1994 (census); Birchfield,
///          Tomasi, "A pixel dissimilarity measure that is insensitive to image sampling", 1998 (intervals; here also along y,
///          as the rows of two webcams never lie quite true)
inline constexpr int kCensus[16][2] = {  // x, y
    {-2, -2}, {0, -2}, {2, -2}, {-1, -1}, {1, -1}, {-3, 0}, {-2, 0}, {-1, 0},
    {1, 0},   {2, 0},  {3, 0},  {-1, 1},  {1, 1},  {-2, 2}, {0, 2},  {2, 2}};

namespace ref {
void match_planes(View<const std::uint8_t> gray, View<const std::uint8_t> inside, int dead_zone, bool clear, PlaneImages& out);
}
namespace simd {
/// Of the rows from the top as many as `rows`; others may hold anything.
void match_planes(Pool& pool, View<const std::uint8_t> gray, View<const std::uint8_t> inside, int dead_zone, bool clear,
                  int rows, PlaneImages& out);
}  // namespace simd

}  // namespace duo
