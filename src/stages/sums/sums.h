// Sums over an area: count, moments, disparity, hue.
#pragma once

#include <cstdint>
#include <optional>

#include "core/area.h"
#include "core/pool.h"

namespace duo {

/// Means and axes follow without the picture.
///
/// Units   pixels; d_q4 1/16 px over the `known` pixels that have a disparity; hue sums of the cosine and sine in 1/16384
struct AreaSums {
  std::int64_t count = 0, x = 0, y = 0, xx = 0, xy = 0, yy = 0;
  std::int64_t known = 0, d_q4 = 0;
  std::int64_t hue_cos_q14 = 0, hue_sin_q14 = 0;
  Pixel first = {}, last = {};  // upper left and lower right corner of the bounding box, both inside
  friend bool operator==(const AreaSums&, const AreaSums&) = default;
};

/// Sums over the pixels of an area: see AreaSums.
///
/// Shape    hue and d_q4 H x W; either may be empty = not summed
/// Units    as in AreaSums: 64 bits hold the sums of any picture up to 32768 x 32768
/// Threads  rows are independent; sums of integers do not depend on their order
/// Exact    ref, simd and vk agree bit for bit
/// Source   ours; moments after Hu, "Visual pattern recognition by moment invariants", 1962; hue as a mean direction (Mardia,
///          "Statistics of directional data", 1972), because plain means break at red
struct Sums {
  Size size;  // of the picture
  Area area;
  View<const std::uint8_t> hue = {};
  View<const std::uint16_t> d_q4 = {};
};

/// The hue whose direction fits the sums best, the lowest where several do; none for an area without a mean direction.
std::optional<std::uint8_t> mean_hue(const AreaSums& sums);

namespace ref {
AreaSums sums(const Sums& in);
}
namespace simd {
AreaSums sums(Pool& pool, const Sums& in);
}

}  // namespace duo
