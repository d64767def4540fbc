// Lanes are bytes of a descriptor; a stored one stays in registers while all seen ones pass.

#include <limits>

#include "core/check.h"
#include "stages/match_points/match_points.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "stages/match_points/match_points_simd.cpp"
#include <hwy/foreach_target.h>
// After foreach_target.h, as Highway asks.
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace duo::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

HWY_INLINE std::int32_t square_distance(const std::uint8_t* a, const std::uint8_t* b) {
  const hn::CappedTag<std::int16_t, 32> d16;
  const hn::Rebind<std::uint8_t, decltype(d16)> d8;
  const hn::Repartition<std::int32_t, decltype(d16)> d32;
  auto even = hn::Zero(d32), odd = hn::Zero(d32);
  for (std::size_t i = 0; i < SiftPoints::kDescriptor; i += hn::Lanes(d16)) {
    const auto step = hn::Sub(hn::PromoteTo(d16, hn::LoadU(d8, a + i)), hn::PromoteTo(d16, hn::LoadU(d8, b + i)));
    even = hn::ReorderWidenMulAccumulate(d32, step, step, even, odd);
  }
  return hn::GetLane(hn::SumOfLanes(d32, hn::Add(even, odd)));
}

/// Matches of the stored points [begin, end).
void match_stored(const SiftPoints& stored, std::span<const PredictedPlace> predicted, const SiftPoints& seen,
                  const MatchPointsParams& params, std::span<PointMatch> matches, int begin, int end) {
  constexpr std::int32_t kFar = std::numeric_limits<std::int32_t>::max();
  const float square_reach = params.reach_px * params.reach_px;
  const std::int64_t share = std::int64_t{params.ratio_percent} * params.ratio_percent;
  const auto distance = [&](int i, int j) HWY_ATTR {
    if (!predicted.empty()) {
      const PredictedPlace& place = predicted[static_cast<std::size_t>(i)];
      const float dx = seen[j].x_px - place.x_px, dy = seen[j].y_px - place.y_px;
      if (!(dx * dx + dy * dy <= square_reach)) return kFar;
    }
    return square_distance(stored.descriptors.row(i), seen.descriptors.row(j));
  };
  for (int i = begin; i < end; ++i) {
    PointMatch best{PointMatch::kNone, kFar};
    std::int32_t second = kFar;
    for (int j = 0; j < seen.count; ++j) {
      const std::int32_t d = distance(i, j);
      if (d >= second) continue;
      if (d < best.square_distance) {
        second = best.square_distance;
        best = {j, d};
      } else {
        second = d;
      }
    }
    bool good =
        best.seen != PointMatch::kNone && (second == kFar || std::int64_t{best.square_distance} * 10000 < share * second);
    for (int k = 0; good && params.mutual && k < stored.count; ++k) {
      const std::int32_t d = distance(k, best.seen);
      good = k < i ? d > best.square_distance : d >= best.square_distance;
    }
    matches[static_cast<std::size_t>(i)] = good ? best : PointMatch{};
  }
}

}  // namespace duo::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace duo {
HWY_EXPORT(match_stored);

namespace simd {

void match_points(Pool& pool, const SiftPoints& stored, std::span<const PredictedPlace> predicted, const SiftPoints& seen,
                  const MatchPointsParams& params, std::span<PointMatch> matches) {
  const auto count = static_cast<std::size_t>(stored.count);
  DUO_CHECK(matches.size() == count && (predicted.empty() || predicted.size() == count));
  const auto match = HWY_DYNAMIC_DISPATCH(match_stored);
  pool.rows(stored.count, [&](int begin, int end) { match(stored, predicted, seen, params, matches, begin, end); });
}

}  // namespace simd
}  // namespace duo
#endif
