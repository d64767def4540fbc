#include "trackers/body/sides.h"

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

}  // namespace duo::body
