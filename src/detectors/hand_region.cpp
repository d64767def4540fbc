#include <algorithm>

#include "detectors/fixed.h"
#include "detectors/place.h"
#include "duoptic/detector.h"

namespace duo {
namespace {

/// A vector in 1/256 px.
struct Way {
  std::int64_t x = 0, y = 0;
  std::int64_t length() const { return integer_root(x * x + y * y); }
  /// With a length of 4096; none of a point.
  Way unit() const {
    const std::int64_t n = length();
    return n == 0 ? Way() : Way{x * 4096 / n, y * 4096 / n};
  }
};

Way between(const SeenPoint& from, const SeenPoint& to) {
  return {std::int64_t{to.x_q8} - from.x_q8, std::int64_t{to.y_q8} - from.y_q8};
}

constexpr BodyPoint kTorso[] = {BodyPoint::kLeftShoulder, BodyPoint::kRightShoulder, BodyPoint::kLeftHip, BodyPoint::kRightHip};

/// 1/256 px a metre at the torso: how far its corners spread in the picture, and how far across the view in metres.
std::int64_t scale_at_torso(const SeenBody& body) {
  std::int64_t x = 0, y = 0, wx = 0, wy = 0;
  for (const BodyPoint corner : kTorso) {
    const SeenPoint& point = body.at(corner);
    x += point.x_q8;
    y += point.y_q8;
    wx += point.world_q16[0];
    wy += point.world_q16[1];
  }
  std::int64_t picture = 0, world = 0;  // squares: 2^-16 px², 2^-24 m²
  for (const BodyPoint corner : kTorso) {
    const SeenPoint& point = body.at(corner);
    const std::int64_t dx = point.x_q8 - x / 4, dy = point.y_q8 - y / 4;
    const std::int64_t dwx = (point.world_q16[0] - wx / 4) / 16, dwy = (point.world_q16[1] - wy / 4) / 16;
    picture += dx * dx + dy * dy;
    world += dwx * dwx + dwy * dwy;
  }
  return integer_root((picture << 14) / std::max<std::int64_t>(world >> 10, 1));
}

/// The same at a wrist that is nearer or farther than the torso, for a lens that sees about 60 degrees; at most 1.6 times as
/// large.
std::int64_t scale_at_wrist(std::int64_t torso, const SeenBody& body, const SeenPoint& wrist, Size picture) {
  std::int64_t torso_z = 0;  // 1/65536 m from the hips
  for (const BodyPoint corner : kTorso) torso_z += body.at(corner).world_q16[2];
  const std::int64_t focal_px = std::max(picture.width, picture.height) * 7 / 8;
  const std::int64_t distance = (focal_px << 24) / std::max<std::int64_t>(torso, 1);
  const std::int64_t wrist_distance = std::max(distance + wrist.world_q16[2] - torso_z / 4, distance * 5 / 8);
  return torso * distance / std::max<std::int64_t>(wrist_distance, 1);
}

}  // namespace

std::optional<TurnedSquare> hand_region(const SeenBody& body, bool left, Size picture) {
  const SeenPoint& wrist = body.at(left ? BodyPoint::kLeftWrist : BodyPoint::kRightWrist);
  const SeenPoint& elbow = body.at(left ? BodyPoint::kLeftElbow : BodyPoint::kRightElbow);
  const SeenPoint& index = body.at(left ? BodyPoint::kLeftIndex : BodyPoint::kRightIndex);
  const SeenPoint& pinky = body.at(left ? BodyPoint::kLeftPinky : BodyPoint::kRightPinky);
  const std::int64_t scale = scale_at_wrist(scale_at_torso(body), body, wrist, picture);
  const SeenPoint knuckles = {(index.x_q8 + pinky.x_q8) / 2, (index.y_q8 + pinky.y_q8) / 2};
  const Way hand = between(wrist, knuckles).unit(), forearm = between(elbow, wrist).unit();
  const Way along = Way{6 * hand.x + 4 * forearm.x, 6 * hand.y + 4 * forearm.y}.unit();
  // Knuckles lie 8.5 cm beyond the wrist; where the hand points at the camera the network sees them nearer.
  const auto mean = [&](std::int64_t from, std::int64_t way, std::int64_t knuckle) {
    return static_cast<std::int32_t>((from + way * scale * 85 / 1000 / 4096 + knuckle) / 2);
  };
  const std::int64_t half = scale * 15 / 100;
  const TurnedSquare region = {mean(wrist.x_q8, along.x, knuckles.x_q8), mean(wrist.y_q8, along.y, knuckles.y_q8),
                               static_cast<std::int32_t>(-along.y * half / 4096),
                               static_cast<std::int32_t>(along.x * half / 4096)};
  if (region.x_q8 < 0 || region.y_q8 < 0 || region.x_q8 >= picture.width * 256 || region.y_q8 >= picture.height * 256)
    return std::nullopt;
  if (!usable(region, picture)) return std::nullopt;
  return region;
}

}  // namespace duo
