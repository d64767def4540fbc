#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "core/check.h"
#include "duoptic/statistics.h"
#include "trackers/thesis/place_joints.h"

namespace duo::ref {
namespace {

std::int32_t mean_q4(std::int64_t sum, std::int64_t count) {
  return static_cast<std::int32_t>((32 * sum + count) / (2 * count));
}

std::int32_t rounded_q4(float at_px) { return static_cast<std::int32_t>(std::floor(16.0f * at_px + 0.5f)); }

std::optional<PlaceQ4> place_of_points(const JointEvidence& in) {
  std::array<std::int32_t, JointPoints::kCapacity> x, y;
  std::size_t votes = 0;
  for (std::size_t i = 0; i < in.matches.size(); ++i) {
    if (in.matches[i].seen == PointMatch::kNone) continue;
    const SiftPoint& p = (*in.seen)[in.matches[i].seen];
    x[votes] = rounded_q4(p.x_px) + in.to_joint[i].x;
    y[votes++] = rounded_q4(p.y_px) + in.to_joint[i].y;
  }
  if (votes < kLeastVotes) return {};
  return PlaceQ4{median(std::span(x).first(votes)), median(std::span(y).first(votes))};
}

}  // namespace

ObservedJoint place_joint(const JointEvidence& in, View<const std::uint16_t> d_q4) {
  DUO_CHECK(in.matches.size() <= JointPoints::kCapacity && in.to_joint.size() >= in.matches.size());
  ObservedJoint out{in.expected};
  if (in.color->count >= kLeastBlobPixels) {
    out.seen_by |= kSeenByColor;
    out.at = {mean_q4(in.color->x, in.color->count), mean_q4(in.color->y, in.color->count)};
  }
  if (const auto second = place_of_points(in)) {
    out.at = out.seen_by == 0 ? *second : PlaceQ4{(out.at.x + second->x) >> 1, (out.at.y + second->y) >> 1};
    out.seen_by |= kSeenByPoints;
  }
  const Pixel p = out.at.pixel();
  if (p.x >= 0 && p.y >= 0 && p.x < d_q4.width() && p.y < d_q4.height()) out.d_q4 = d_q4.at(p.y, p.x);
  return out;
}

}  // namespace duo::ref
