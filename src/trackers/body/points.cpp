#include "trackers/body/points.h"

#include <algorithm>
#include <utility>

namespace duo::body {
namespace {

constexpr double kCropSide_px = 256;
constexpr double kPoint_crop_px = 1.5;  // one standard deviation of a visible point

struct Source {
  JointId joint;
  BodyPoint point;
};
constexpr Source kSources[] = {
    {JointId::kLeftShoulder, BodyPoint::kLeftShoulder}, {JointId::kRightShoulder, BodyPoint::kRightShoulder},
    {JointId::kLeftElbow, BodyPoint::kLeftElbow},       {JointId::kRightElbow, BodyPoint::kRightElbow},
    {JointId::kLeftWrist, BodyPoint::kLeftWrist},       {JointId::kRightWrist, BodyPoint::kRightWrist},
    {JointId::kLeftHip, BodyPoint::kLeftHip},           {JointId::kRightHip, BodyPoint::kRightHip},
    {JointId::kLeftKnee, BodyPoint::kLeftKnee},         {JointId::kRightKnee, BodyPoint::kRightKnee},
    {JointId::kLeftAnkle, BodyPoint::kLeftAnkle},       {JointId::kRightAnkle, BodyPoint::kRightAnkle},
    {JointId::kLeftFoot, BodyPoint::kLeftFootIndex},    {JointId::kRightFoot, BodyPoint::kRightFootIndex},
};

// Widths of the shoulders: down along the trunk, and outwards from its middle.
struct Offset {
  double down = 0, out = 0;
};
struct Offsets {
  Offset shoulder, hip, head;
};
constexpr Offsets kLiteOffsets = {{0.053, 0.033}, {-0.085, 0}, {-0.145, 0}};
constexpr Offsets kFullOffsets = {{0.06, 0.027}, {-0.055, 0.01}, {-0.135, 0}};

// Elbows, wrists and knees are marked a little beyond their centres, by a share of the bone.
constexpr double kBack = 0.03, kElbowBack = 0.01;
struct TooFar {
  JointId end;
  BodyPoint from;
  double share = kBack;
};
constexpr TooFar kTooFar[] = {{JointId::kLeftElbow, BodyPoint::kLeftShoulder, kElbowBack},
                              {JointId::kRightElbow, BodyPoint::kRightShoulder, kElbowBack},
                              {JointId::kLeftWrist, BodyPoint::kLeftElbow},
                              {JointId::kRightWrist, BodyPoint::kRightElbow},
                              {JointId::kLeftKnee, BodyPoint::kLeftHip},
                              {JointId::kRightKnee, BodyPoint::kRightHip}};

Vec2 at(const SeenPoint& point) { return {point.x_px(), point.y_px()}; }

/// Half the side of the region that the points were found in, by the one that follows from them.
double half_side_px(const SeenBody& body) {
  const double x = body.next.right_x_q8 / 256.0, y = body.next.right_y_q8 / 256.0;
  return std::sqrt(x * x + y * y);
}

}  // namespace

double lifted(const SeenBody& body, bool left, double width_px) {
  constexpr double kFrom = 0.45, kTo = 0.75;  // of the upper arm's length, outwards in the picture
  using enum BodyPoint;
  const Vec2 own = at(body.at(left ? kLeftShoulder : kRightShoulder)),
             other = at(body.at(left ? kRightShoulder : kLeftShoulder)), elbow = at(body.at(left ? kLeftElbow : kRightElbow));
  const Vec2 arm = {elbow.x - own.x, elbow.y - own.y}, outwards = {own.x - other.x, own.y - other.y};
  const double wide = distance(own, other);
  const double out = (arm.x * outwards.x + arm.y * outwards.y) / std::max(wide * distance(arm, {}), 1.0);
  const double facing = std::min(wide / std::max(width_px, 1.0), 1.0);
  return std::clamp((facing * out - kFrom) / (kTo - kFrom), 0.0, 1.0);
}

Points points_of(const SeenBody& body, BodyModel model, Size picture, double px_per_m, double shoulder_width_m, double ahead_m,
                 double hips_low_m) {
  const Offsets& offsets = model == BodyModel::kLite ? kLiteOffsets : kFullOffsets;
  using enum BodyPoint;
  const double crop_px = std::max(2 * half_side_px(body) / kCropSide_px, 0.25);
  Points out;
  const auto put = [&](JointId joint, Vec2 place, double visibility) {
    Point& point = out[joint];
    point.at_px = place;
    point.visibility = visibility;
    point.sigma_px = kPoint_crop_px * crop_px / std::sqrt(std::max(visibility, 0.1));
    point.inside = place.x >= 0 && place.y >= 0 && place.x <= picture.width - 1 && place.y <= picture.height - 1;
  };
  for (const Source& source : kSources) put(source.joint, at(body.at(source.point)), body.at(source.point).visibility());
  for (const auto& [end, from, share] : kTooFar) {
    const Vec2 a = at(body.at(from)), b = out[end].at_px;
    put(end, {b.x + share * (a.x - b.x), b.y + share * (a.y - b.y)}, out[end].visibility);
  }

  const Vec2 shoulders = mean(at(body.at(kLeftShoulder)), at(body.at(kRightShoulder)));
  const Vec2 hips = mean(at(body.at(kLeftHip)), at(body.at(kRightHip)));
  const double trunk_px = std::max(std::sqrt(square(hips.x - shoulders.x) + square(hips.y - shoulders.y)), 1.0);
  const double per_width = px_per_m * shoulder_width_m / trunk_px;
  const Vec2 down = {(hips.x - shoulders.x) * per_width, (hips.y - shoulders.y) * per_width};
  const auto moved = [&](Vec2 place, Offset offset, Vec2 outwards) {
    return Vec2{place.x + offset.down * down.x + offset.out * outwards.x,
                place.y + offset.down * down.y + offset.out * outwards.y};
  };
  const Vec2 left = at(body.at(kLeftShoulder)), right = at(body.at(kRightShoulder));
  const Vec2 to_left = {left.x - right.x, left.y - right.y}, to_right = {-to_left.x, -to_left.y};
  const auto shift = [&](JointId joint, Offset offset, Vec2 outwards) {
    put(joint, moved(out[joint].at_px, offset, outwards), out[joint].visibility);
  };
  const auto shoulder = [&](bool of_left) {
    return Offset{offsets.shoulder.down - kLift * lifted(body, of_left, px_per_m * shoulder_width_m), offsets.shoulder.out};
  };
  shift(JointId::kLeftShoulder, shoulder(true), to_left);
  shift(JointId::kRightShoulder, shoulder(false), to_right);
  const double ahead = ahead_m / shoulder_width_m;
  const auto moved_back = [&](Vec2 place) { return Vec2{place.x - ahead * down.y, place.y + ahead * down.x}; };
  for (const auto& [hip, outwards] : {std::pair{JointId::kLeftHip, to_left}, std::pair{JointId::kRightHip, to_right}}) {
    const Offset offset = {offsets.hip.down - hips_low_m / shoulder_width_m, offsets.hip.out};
    put(hip, moved_back(moved(out[hip].at_px, offset, outwards)), out[hip].visibility);
  }
  const SeenPoint &left_ear = body.at(kLeftEar), &right_ear = body.at(kRightEar);
  put(JointId::kHead, moved_back(moved(mean(at(left_ear), at(right_ear)), offsets.head, {})),
      std::max(left_ear.visibility(), right_ear.visibility()));

  // The middle of wrist and three knuckles is steadier than any of them.
  const auto hand = [&](JointId joint, BodyPoint wrist, BodyPoint index, BodyPoint pinky, BodyPoint thumb) {
    const Vec2 place = mean(mean(at(body.at(wrist)), at(body.at(index))), mean(at(body.at(pinky)), at(body.at(thumb))));
    put(joint, place, (body.at(index).visibility() + body.at(pinky).visibility()) / 2);
  };
  hand(JointId::kLeftHand, kLeftWrist, kLeftIndex, kLeftPinky, kLeftThumb);
  hand(JointId::kRightHand, kRightWrist, kRightIndex, kRightPinky, kRightThumb);
  return out;
}

HandShift take_hand(const SeenHand& hand, bool left, Points& points) {
  constexpr std::size_t kWrist = 0, kMiddleKnuckle = 9;
  constexpr double kPalm = 0.65, kSharper = 0.5;
  const Vec2 wrist = at(hand.points[kWrist]), knuckle = at(hand.points[kMiddleKnuckle]);
  const Vec2 palm = {(1 - kPalm) * wrist.x + kPalm * knuckle.x, (1 - kPalm) * wrist.y + kPalm * knuckle.y};
  const auto put = [&](JointId id, Vec2 to) {
    Point& point = points[id];
    const Vec2 shift = {to.x - point.at_px.x, to.y - point.at_px.y};
    point.at_px = to;
    point.sigma_px *= kSharper;
    return shift;
  };
  return {put(left ? JointId::kLeftHand : JointId::kRightHand, palm),
          put(left ? JointId::kLeftWrist : JointId::kRightWrist, wrist)};
}

void take_shift(const HandShift& shift, bool left, Points& points) {
  constexpr double kShare = 0.8, kSharper = 0.8;
  const auto put = [&](JointId id, Vec2 by) {
    Point& point = points[id];
    point.at_px = {point.at_px.x + kShare * by.x, point.at_px.y + kShare * by.y};
    point.sigma_px *= kSharper;
  };
  put(left ? JointId::kLeftHand : JointId::kRightHand, shift.palm);
  put(left ? JointId::kLeftWrist : JointId::kRightWrist, shift.wrist);
}

Across across_of(const SeenBody& body, Vec3 ray) {
  // The turn that takes the picture's axis to the ray, for rays within some 40 degrees of it.
  const Vec3 z = normalized(ray), x = normalized(Vec3{z.z, 0, -z.x}), y = cross(z, x);
  const auto line = [&](BodyPoint left, BodyPoint right) {
    const Vec3 way = body.at(left).world_m() - body.at(right).world_m();
    const Vec3 turned = way.x * x + way.y * y + way.z * z;
    const double length = norm(turned);
    return length > 0 ? (1 / length) * turned : x;
  };
  return {line(BodyPoint::kLeftShoulder, BodyPoint::kRightShoulder), line(BodyPoint::kLeftHip, BodyPoint::kRightHip)};
}

}  // namespace duo::body
