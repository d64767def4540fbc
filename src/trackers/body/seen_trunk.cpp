#include "trackers/body/seen_trunk.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace duo::body {
namespace {

/// `across` from left (0) to right (1), `down` from the shoulders (0) to the hips (1).
Vec2 place_in(const TrunkCorners& corners, double across, double down) {
  const auto along = [](Vec2 from, Vec2 to, double t) {
    return Vec2{from.x + t * (to.x - from.x), from.y + t * (to.y - from.y)};
  };
  return along(along(corners[0], corners[1], across), along(corners[2], corners[3], across), down);
}

}  // namespace

TrunkCorners corners_of(const SeenBody& seen) {
  using enum BodyPoint;
  const auto at = [&](BodyPoint point) { return Vec2{seen.at(point).x_px(), seen.at(point).y_px()}; };
  return {at(kLeftShoulder), at(kRightShoulder), at(kLeftHip), at(kRightHip)};
}

Vec2 centre_of(const TrunkCorners& corners) { return mean(mean(corners[0], corners[1]), mean(corners[2], corners[3])); }

TrunkCorners corners_at(const std::array<Vec3, 4>& corners, const Rectified& camera) {
  TrunkCorners out;
  for (std::size_t i = 0; i < out.size(); ++i)
    out[i] = camera.project({corners[i].x, corners[i].y, std::max(corners[i].z, kAnyDepth.near_m)});
  return out;
}

TrunkCorners expected_corners(const Scene& scene) {
  using enum JointId;
  const auto at = [&](JointId id) { return scene.expected[id].p; };
  return corners_at({at(kLeftShoulder), at(kRightShoulder), at(kLeftHip), at(kRightHip)}, *scene.depth.geometry);
}

bool are_sides_exchanged(const TrunkCorners& seen, const TrunkCorners& expected) {
  constexpr double kFromSide = 0.35, kMuchNearer = 0.4;  // shares: of the trunk's length, of the distance
  const double trunk = distance(mean(expected[0], expected[1]), mean(expected[2], expected[3]));
  if (distance(expected[0], expected[1]) < kFromSide * trunk) return false;
  double same = 0, other = 0;
  for (std::size_t i = 0; i < seen.size(); ++i) {
    same += distance(seen[i], expected[i]);
    other += distance(seen[i], expected[i ^ 1]);
  }
  return other < kMuchNearer * same;
}

SeenBody with_sides_exchanged(const SeenBody& seen) {
  using enum BodyPoint;
  constexpr auto kOfFace = std::to_array<std::pair<BodyPoint, BodyPoint>>({{kLeftEyeInner, kRightEyeInner},
                                                                           {kLeftEye, kRightEye},
                                                                           {kLeftEyeOuter, kRightEyeOuter},
                                                                           {kLeftEar, kRightEar},
                                                                           {kMouthLeft, kMouthRight}});
  SeenBody out = seen;
  const auto exchange = [&](std::size_t left, std::size_t right) { std::swap(out.points[left], out.points[right]); };
  for (const auto& [left, right] : kOfFace) exchange(static_cast<std::size_t>(left), static_cast<std::size_t>(right));
  // Below the face, right follows left.
  for (auto i = static_cast<std::size_t>(kLeftShoulder); i + 1 < kBodyPoints; i += 2) exchange(i, i + 1);
  return out;
}

TrunkColor color_of(const FrameView& frame, const TrunkCorners& corners) {
  constexpr int kSide = 12;
  double red = 0, green = 0, blue = 0;
  int count = 0;
  for (int j = 0; j < kSide; ++j)
    for (int i = 0; i < kSide; ++i) {
      const double a = 0.2 + 0.6 * i / (kSide - 1), b = 0.15 + 0.7 * j / (kSide - 1);
      const Vec2 at = place_in(corners, a, b);
      if (!frame.shows(at) || frame.is_covered(at)) continue;
      const Rgb8 pixel = frame.picture.at(static_cast<int>(at.y + 0.5), static_cast<int>(at.x + 0.5));
      red += pixel.r;
      green += pixel.g;
      blue += pixel.b;
      ++count;
    }
  const double sum = red + green + blue;
  if (count < kSide || !(sum > 0)) return {};
  return {red / sum, green / sum, sum / (3 * 255.0 * count), true};
}

void TrunkColor::learn(const TrunkColor& now, double ticks) {
  constexpr double kGain = 0.05;  // per tick
  if (!now.known) return;
  const double gain = known ? gain_over(ticks, kGain) : 1;
  *this = {red + gain * (now.red - red), green + gain * (now.green - green), bright + gain * (now.bright - bright), true};
}

double covered_share(const FrameView& frame, const TrunkCorners& corners) {
  constexpr int kSide = 9;
  int covered = 0;
  for (int j = 0; j < kSide; ++j)
    for (int i = 0; i < kSide; ++i)
      covered += frame.is_covered(place_in(corners, i / (kSide - 1.0), j / (kSide - 1.0))) ? 1 : 0;
  return static_cast<double>(covered) / (kSide * kSide);
}

}  // namespace duo::body
