#include "trackers/body/sides.h"

#include <utility>

namespace duo::body {
namespace {

/// Whether the trunk is seen from behind: its left is to the left of the way down.
bool shows_back(const TrunkCorners& corners) {
  const Vec2 left = mean(corners[0], corners[2]), right = mean(corners[1], corners[3]);
  const Vec2 up = mean(corners[0], corners[1]), down = mean(corners[2], corners[3]);
  return (left.x - right.x) * (down.y - up.y) < (left.y - right.y) * (down.x - up.x);
}

}  // namespace

bool Sides::are_exchanged(const SeenBody& seen, const TrunkCorners& expected, double ticks) {
  constexpr int kEnoughAgreed = 5;
  constexpr double kMostExchanged = 8;  // ticks; then the network is right
  constexpr double kLongestStep = 2;    // ticks: in a longer one people turn
  if (!are_sides_exchanged(corners_of(seen), expected)) {
    ++agreed_;
    exchanged_ = 0;
    return false;
  }
  exchanged_ += ticks;
  if (agreed_ >= kEnoughAgreed && exchanged_ <= kMostExchanged && ticks <= kLongestStep && shows_back(expected)) return true;
  agreed_ = 0;
  return false;
}

void LegSides::put_right(Scene& scene, double ticks) {
  constexpr int kEnoughAgreed = 3;
  constexpr double kMostExchanged = 4;        // ticks; then the network is right
  constexpr double kLongestStep = 2;          // ticks: in a longer one legs pass each other
  constexpr double kLess = 0.5;               // of the distance from where they are expected
  constexpr double kLeast_m = 0.3;            // by which the distance of all four falls
  constexpr double kAgrees_m = 0.0625;        // mean of the four, hidden ones counting less
  constexpr double kHiddenCountsLess = 0.25;  // per tick
  const auto off_px = [&](JointId marked, JointId expected) {
    const Vec3 p = scene.expected[expected].p;
    const Vec2 there = scene.depth.geometry->project({p.x, p.y, std::max(p.z, kAnyDepth.near_m)});
    return distance(scene.points[marked].at_px, there);
  };
  double same_px = 0, other_px = 0, weights = 0;
  for (const std::size_t n : {1, 2}) {
    const JointId left = kLegChains[0][n], right = kLegChains[1][n];
    const double hidden = scene.expected[left].hidden + scene.expected[right].hidden;
    const double weight = 1 / (1 + kHiddenCountsLess * hidden);
    weights += 2 * weight;
    same_px += weight * (off_px(left, left) + off_px(right, right));
    other_px += weight * (off_px(left, right) + off_px(right, left));
  }
  const double px_per_m = scene.depth.px_per_m(scene.trunk_z_m);
  if (!(other_px < kLess * same_px && same_px - other_px > kLeast_m * px_per_m)) {
    agreed_ = same_px < weights * kAgrees_m * px_per_m ? agreed_ + 1 : 0;
    exchanged_ = 0;
    return;
  }
  exchanged_ += ticks;
  if (agreed_ < kEnoughAgreed || exchanged_ > kMostExchanged || ticks > kLongestStep) {
    agreed_ = 0;
    return;
  }
  for (const std::size_t n : {1, 2, 3}) std::swap(scene.points[kLegChains[0][n]], scene.points[kLegChains[1][n]]);
}

}  // namespace duo::body
