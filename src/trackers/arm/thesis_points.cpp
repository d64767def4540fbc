#include "trackers/arm/thesis_points.h"

#include <algorithm>
#include <cmath>

namespace duo::arm {
namespace {

double median(std::vector<double>& values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

}  // namespace

PointFinder::PointFinder(Size largest_window)
    : scratch_(std::in_place, largest_window, kCapacity), seen_(kCapacity), matches_(kCapacity) {
  x_px_.reserve(kCapacity);
  y_px_.reserve(kCapacity);
}

void PointFinder::learn(Pool& pool, const Image<std::uint8_t>& gray, const Window& window, Vec2 joint_px, JointPoints& out) {
  out.points = SiftPoints(kCapacity);
  simd::sift(pool, gray.view(), window, params_, *scratch_, out.points);
  out.to_joint_px.clear();
  for (int i = 0; i < out.points.count; ++i)
    out.to_joint_px.push_back({joint_px.x - out.points[i].x_px, joint_px.y - out.points[i].y_px});
}

std::optional<Vec2> PointFinder::find(Pool& pool, const Image<std::uint8_t>& gray, const Window& window,
                                      const JointPoints& stored) {
  constexpr std::size_t kLeastMatches = 3;
  if (stored.points.count == 0) return {};
  simd::sift(pool, gray.view(), window, params_, *scratch_, seen_);
  const std::span matches(matches_.data(), static_cast<std::size_t>(stored.points.count));
  simd::match_points(pool, stored.points, {}, seen_, {}, matches);
  x_px_.clear();
  y_px_.clear();
  for (std::size_t i = 0; i < matches.size(); ++i) {
    if (matches[i].seen == PointMatch::kNone) continue;
    const SiftPoint& p = seen_[matches[i].seen];
    x_px_.push_back(p.x_px + stored.to_joint_px[i].x);
    y_px_.push_back(p.y_px + stored.to_joint_px[i].y);
  }
  if (x_px_.size() < kLeastMatches) return {};
  return Vec2{median(x_px_), median(y_px_)};
}

}  // namespace duo::arm
