#include <limits>

#include "core/check.h"
#include "stages/match_points/match_points.h"

namespace duo::ref {
namespace {

constexpr std::int32_t kFar = std::numeric_limits<std::int32_t>::max();

std::int32_t square_distance(const std::uint8_t* a, const std::uint8_t* b) {
  std::int32_t sum = 0;
  for (int i = 0; i < SiftPoints::kDescriptor; ++i) sum += (a[i] - b[i]) * (a[i] - b[i]);
  return sum;
}

bool within(const SiftPoint& p, const PredictedPlace& place, float reach_px) {
  const float dx = p.x_px - place.x_px, dy = p.y_px - place.y_px;
  return dx * dx + dy * dy <= reach_px * reach_px;
}

}  // namespace

void match_points(const SiftPoints& stored, std::span<const PredictedPlace> predicted, const SiftPoints& seen,
                  const MatchPointsParams& params, std::span<PointMatch> matches) {
  const auto count = static_cast<std::size_t>(stored.count);
  DUO_CHECK(matches.size() == count && (predicted.empty() || predicted.size() == count));
  // kFar where j is no candidate of i.
  const auto distance = [&](int i, int j) {
    if (!predicted.empty() && !within(seen[j], predicted[static_cast<std::size_t>(i)], params.reach_px)) return kFar;
    return square_distance(stored.descriptors.row(i), seen.descriptors.row(j));
  };
  for (int i = 0; i < stored.count; ++i) {
    PointMatch best{PointMatch::kNone, kFar};
    std::int32_t second = kFar;
    for (int j = 0; j < seen.count; ++j) {
      const std::int32_t d = distance(i, j);
      if (d < best.square_distance) {
        second = best.square_distance;
        best = {j, d};
      } else if (d < second) {
        second = d;
      }
    }
    const std::int64_t share = std::int64_t{params.ratio_percent} * params.ratio_percent;
    bool good =
        best.seen != PointMatch::kNone && (second == kFar || std::int64_t{best.square_distance} * 10000 < share * second);
    for (int k = 0; good && params.mutual && k < stored.count; ++k) {
      const std::int32_t d = distance(k, best.seen);
      if (d < best.square_distance || (d == best.square_distance && k < i)) good = false;
    }
    matches[static_cast<std::size_t>(i)] = good ? best : PointMatch{};
  }
}

}  // namespace duo::ref
