// Who is who: how unlike a person somebody seen is.
#include <algorithm>

#include "trackers/body/body.h"

namespace duo::body {
namespace {

/// How far a trunk in the picture is turned from another, 0 .. 2; 0 where one of them is too short to tell.
double turned_away(const TrunkCorners& a, const TrunkCorners& b, double least_px) {
  const auto down = [](const TrunkCorners& c) {
    const Vec2 up = mean(c[0], c[1]), hips = mean(c[2], c[3]);
    return Vec2{hips.x - up.x, hips.y - up.y};
  };
  const Vec2 p = down(a), q = down(b);
  const double p_px = distance(p, {}), q_px = distance(q, {});
  if (p_px < least_px || q_px < least_px) return 0;
  return 1 - (p.x * q.x + p.y * q.y) / (p_px * q_px);
}

}  // namespace

double Body::unlike(const FrameView& frame, const SeenBody& seen) const {
  constexpr double kNear = 0.6, kNear_depth_m = 0.25, kColor = 0.08, kBright = 0.35, kMostOther = 4;
  constexpr double kTurned = 0.3, kLeastTrunk = 0.5;  // by 45 degrees; of the trunk's length
  const auto corners = corners_of(seen);
  const Vec2 centre = centre_of(corners);
  const Vec3 expected = expected_trunk();
  const double z = std::max(expected.z, kAnyDepth.near_m);
  const double aside = 1 + 0.3 * std::min(missed_, 10.0), along = 1 + 0.15 * std::min(missed_, 20.0);
  const Vec2 there = frame.depth.geometry->project({expected.x, expected.y, z});
  const double off = distance(there, centre) / (lengths_[Bone::kTrunk] * frame.depth.px_per_m(z) * kNear * aside);
  const double found = trunk_depth(frame.depth, corners, kAnyDepth);
  const double deep = found > 0 ? (found - trunk_z_m_) / ((kNear_depth_m + 0.5 * frame.depth.m_per_px(z)) * along) : 0;
  const TrunkColor color = color_of(frame, corners);
  double other = 0;
  if (color.known && color_.known)
    other = (square(color.red - color_.red) + square(color.green - color_.green)) / square(kColor) +
            square((color.bright - color_.bright) / kBright);
  // Nobody lies down from one tick to the next.
  const double lies = 1 + 0.3 * std::min(missed_ + std::max(frame.ticks() - 1, 0.0), 10.0);
  using enum JointId;
  const Places& now = fitted_.places;
  const TrunkCorners ahead =
      corners_at({now[kLeftShoulder], now[kRightShoulder], now[kLeftHip], now[kRightHip]}, *frame.depth.geometry);
  const double turned =
      turned_away(ahead, corners, kLeastTrunk * lengths_[Bone::kTrunk] * frame.depth.px_per_m(z)) / (kTurned * lies);
  return std::sqrt(square(off) + square(deep) + square(turned) + std::min(other, kMostOther) / 4);
}

}  // namespace duo::body
