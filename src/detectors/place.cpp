#include "detectors/place.h"

#include <algorithm>
#include <cstdlib>

#include "detectors/fixed.h"

namespace duo {

PointQ8 placed(const TurnedSquare& region, PointQ8 in_crop, int side) {
  const std::int64_t half = 128 * side;  // 1/256 px
  const std::int64_t u = in_crop.x - half, v = in_crop.y - half;
  const auto sum = [&](std::int64_t a, std::int64_t b) {
    return static_cast<std::int32_t>(rounded_quotient(u * a + v * b, half));
  };
  return {region.x_q8 + sum(region.right_x_q8, -std::int64_t{region.right_y_q8}),
          region.y_q8 + sum(region.right_y_q8, region.right_x_q8)};
}

std::int32_t placed_length(const TurnedSquare& region, std::int32_t length, int side) {
  return static_cast<std::int32_t>(rounded_quotient(std::int64_t{length} * half_side(region), 128 * side));
}

TurnedSquare region_around(PointQ8 center, PointQ8 top) {
  const std::int64_t up_x = std::int64_t{top.x} - center.x, up_y = std::int64_t{top.y} - center.y;
  return {center.x, center.y, static_cast<std::int32_t>(rounded_quotient(-up_y * kRegionMargin, kRegionMarginOf)),
          static_cast<std::int32_t>(rounded_quotient(up_x * kRegionMargin, kRegionMarginOf))};
}

std::int32_t half_side(const TurnedSquare& region) {
  const std::int64_t x = region.right_x_q8, y = region.right_y_q8;
  return static_cast<std::int32_t>(integer_root(x * x + y * y));
}

bool usable(const TurnedSquare& region, Size picture) {
  const std::int64_t width = picture.width * 256, height = picture.height * 256;
  const auto near = [](std::int64_t at, std::int64_t size) { return at > -size && at < 2 * size; };
  if (!near(region.x_q8, width) || !near(region.y_q8, height)) return false;
  const std::int64_t most = 2 * std::max(width, height);
  if (std::abs(std::int64_t{region.right_x_q8}) > most || std::abs(std::int64_t{region.right_y_q8}) > most) return false;
  // The crop is cut out by numbers of 32 bits, in 1/65536 px.
  const auto inside = [&](std::int64_t at) {
    return std::abs(at) + std::abs(std::int64_t{region.right_x_q8}) + std::abs(std::int64_t{region.right_y_q8}) < 1 << 23;
  };
  if (!inside(region.x_q8) || !inside(region.y_q8)) return false;
  const std::int32_t half = half_side(region);
  return half >= 4 * 256 && half <= most;
}

}  // namespace duo
