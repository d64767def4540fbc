#include "detectors/see_points.h"

#include <algorithm>

#include "detectors/fixed.h"
#include "detectors/place.h"

namespace duo {
namespace {

constexpr int kHeatPixel = 1024;  // 1/256 px of the crop in a place of the heat map
constexpr int kHeatReach = 3;
constexpr std::uint16_t kLeastHeat = 16384;  // 0.5
constexpr int kPointValues = 5;

std::uint16_t probability(const Result16& logit, int at) {
  return sigmoid_q15(rescaled(logit.values.data()[at], logit.exponent, 7));
}

/// `point` drawn to the warmest places near it, when they are warm enough.
PointQ8 drawn_to_heat(PointQ8 point, const Result16& heat, int channel) {
  const int column = point.x / kHeatPixel, row = point.y / kHeatPixel;
  const int width = heat.values.width(), height = heat.values.height();
  if (column < 0 || column >= width || row < 0 || row >= height) return point;
  std::int64_t sum = 0, sum_x = 0, sum_y = 0;
  std::uint16_t most = 0;
  for (int y = std::max(row - kHeatReach, 0); y <= std::min(row + kHeatReach, height - 1); ++y)
    for (int x = std::max(column - kHeatReach, 0); x <= std::min(column + kHeatReach, width - 1); ++x) {
      const std::uint16_t warm = probability(heat, static_cast<int>(heat.values.pixel(y, x) - heat.values.data()) + channel);
      most = std::max(most, warm);
      sum += warm;
      sum_x += std::int64_t{warm} * x;
      sum_y += std::int64_t{warm} * y;
    }
  if (most < kLeastHeat) return point;
  return {static_cast<std::int32_t>(rounded_quotient(kHeatPixel * sum_x, sum)),
          static_cast<std::int32_t>(rounded_quotient(kHeatPixel * sum_y, sum))};
}

/// World axes of the crop turned to those of the picture.
std::array<std::int32_t, 3> turned(const std::int16_t* world, int exponent, const TurnedSquare& region) {
  const std::int64_t x = rescaled(world[0], exponent, 16), y = rescaled(world[1], exponent, 16);
  const std::int64_t length = std::max<std::int64_t>(half_side(region), 1);
  return {static_cast<std::int32_t>(rounded_quotient(x * region.right_x_q8 - y * region.right_y_q8, length)),
          static_cast<std::int32_t>(rounded_quotient(x * region.right_y_q8 + y * region.right_x_q8, length)),
          rescaled(world[2], exponent, 16)};
}

}  // namespace

SeenBody see_body(const Result16& points, const Result16& heat, const Result16& world, const Result16& presence,
                  const TurnedSquare& region) {
  SeenBody body;
  body.score_q15 = probability(presence, 0);
  const auto place = [&](int i) {
    const std::int16_t* raw = points.values.data() + kPointValues * i;
    const PointQ8 in_crop = {rescaled(raw[0], points.exponent, 8), rescaled(raw[1], points.exponent, 8)};
    return placed(region, drawn_to_heat(in_crop, heat, i), kBodySide);
  };
  for (int i = 0; i < static_cast<int>(kBodyPoints); ++i) {
    SeenPoint& point = body.points[i];
    const PointQ8 at = place(i);
    point.x_q8 = at.x;
    point.y_q8 = at.y;
    const int raw = kPointValues * i;
    point.z_q8 = placed_length(region, rescaled(points.values.data()[raw + 2], points.exponent, 8), kBodySide);
    point.visible_q15 = probability(points, raw + 3);
    point.present_q15 = probability(points, raw + 4);
    point.world_q16 = turned(world.values.data() + 3 * i, world.exponent, region);
  }
  body.next = region_around(place(kBodyPoints), place(kBodyPoints + 1));
  return body;
}

SeenHand see_hand(const Result16& points, const Result16& world, const Result16& presence, const Result16& side,
                  const TurnedSquare& region) {
  SeenHand hand;
  hand.score_q15 = probability(presence, 0);
  hand.right_q15 = static_cast<std::uint16_t>(32768 - probability(side, 0));  // it was taught with mirrored pictures
  for (int i = 0; i < static_cast<int>(kHandPoints); ++i) {
    SeenPoint& point = hand.points[i];
    const std::int16_t* raw = points.values.data() + 3 * i;
    const PointQ8 at = placed(region, {rescaled(raw[0], points.exponent, 8), rescaled(raw[1], points.exponent, 8)}, kHandSide);
    point.x_q8 = at.x;
    point.y_q8 = at.y;
    point.z_q8 = placed_length(region, rescaled(raw[2], points.exponent, 8), kHandSide);
    point.world_q16 = turned(world.values.data() + 3 * i, world.exponent, region);
    point.visible_q15 = point.present_q15 = 32768;
  }
  return hand;
}

}  // namespace duo
