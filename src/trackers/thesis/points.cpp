#include "trackers/thesis/points.h"

#include <cmath>

namespace duo::thesis {

PointFinder::PointFinder(Size largest_window)
    : scratch_(std::in_place, largest_window, JointPoints::kCapacity),
      seen_(JointPoints::kCapacity),
      matches_(JointPoints::kCapacity) {}

JointPoints PointFinder::learn(Pool& pool, const Image<std::uint8_t>& gray, const Window& window, PlaceQ4 joint) {
  JointPoints out{SiftPoints(JointPoints::kCapacity), {}};
  simd::sift(pool, gray.view(), window, params_, *scratch_, out.points);
  for (int i = 0; i < out.points.count; ++i) {
    const auto q4 = [](float at_px) { return static_cast<std::int32_t>(std::lround(16 * at_px)); };
    out.to_joint.push_back({joint.x - q4(out.points[i].x_px), joint.y - q4(out.points[i].y_px)});
  }
  return out;
}

std::span<const PointMatch> PointFinder::find(Pool& pool, const Image<std::uint8_t>& gray, const Window& window,
                                              const JointPoints& stored) {
  const std::span matches(matches_.data(), static_cast<std::size_t>(stored.points.count));
  if (matches.empty()) return {};
  simd::sift(pool, gray.view(), window, params_, *scratch_, seen_);
  simd::match_points(pool, stored.points, {}, seen_, {}, matches);
  return matches;
}

}  // namespace duo::thesis
