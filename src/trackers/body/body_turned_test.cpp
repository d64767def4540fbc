// One person by hand: turned from the cameras, and with thighs that point at them.
#include <gtest/gtest.h>

#include "trackers/body/body.h"
#include "trackers/body/standing.h"

namespace duo::body {
namespace {

using namespace test;  // NOLINT: the made-up person

/// A frame that shows a person: its skin before a wall, 4 m away, and what the network of bodies says.
struct Shown {
  Map map;
  Image<Rgb8> picture = Image<Rgb8>({320, 240});
  FrameView frame;
  SeenBody seen;

  Shown(const Places& places, Vec3 across) : seen(marks_of(places)) {
    map.fill({0, 0, 320, 240}, 4);
    const Standing s(places, across);
    const auto at = [&](JointId id) { return s.scene.points[id].at_px; };
    const auto skin = [&](JointId id) { return s.scene.surfaces[id].all[0].z_m; };
    for (const auto& limbs : {kArmChains, kLegChains})
      for (const Limb& limb : limbs)
        for (std::size_t n = 0; n + 1 < limb.size(); ++n) strip(at(limb[n]), skin(limb[n]), at(limb[n + 1]), skin(limb[n + 1]));
    for (double t = 0; t <= 1; t += 1.0 / 16) {
      const auto mix = [&](auto of, JointId left, JointId right) { return (1 - t) * of(left) + t * of(right); };
      const auto x = [&](JointId id) { return at(id).x; };
      const auto y = [&](JointId id) { return at(id).y; };
      strip({mix(x, kLeftShoulder, kRightShoulder), mix(y, kLeftShoulder, kRightShoulder) - kHalf},
            mix(skin, kLeftShoulder, kRightShoulder), {mix(x, kLeftHip, kRightHip), mix(y, kLeftHip, kRightHip)},
            mix(skin, kLeftHip, kRightHip), 2);
    }
    strip({at(kHead).x, at(kHead).y - kHalf}, skin(kHead), {at(kHead).x, at(kHead).y + kHalf}, skin(kHead));
    frame = {map.view(), picture, 1.0 / 30, BodyModel::kLite, {}};
    // Marks that the network's offsets take to the joints.
    const Points points = points_of(seen, frame.model, picture.size(), 200, Lengths()[Bone::kShoulders], 0, 0);
    move(BodyPoint::kLeftEar, at(kHead).x - points[kHead].at_px.x, at(kHead).y - points[kHead].at_px.y);
    move(BodyPoint::kRightEar, at(kHead).x - points[kHead].at_px.x, at(kHead).y - points[kHead].at_px.y);
    for (const auto& [point, id] :
         {std::pair{BodyPoint::kLeftHip, kLeftHip}, std::pair{BodyPoint::kRightHip, kRightHip},
          std::pair{BodyPoint::kLeftShoulder, kLeftShoulder}, std::pair{BodyPoint::kRightShoulder, kRightShoulder}})
      move(point, at(id).x - points[id].at_px.x, at(id).y - points[id].at_px.y);
  }
  void move(BodyPoint point, double x_px, double y_px) {
    SeenPoint& mark = seen.points[static_cast<std::size_t>(point)];
    mark.x_q8 += static_cast<std::int32_t>(std::lround(256 * x_px));
    mark.y_q8 += static_cast<std::int32_t>(std::lround(256 * y_px));
  }
  std::optional<Body> followed() const {
    std::optional<Body> body = Body::start(frame, seen);
    for (int i = 0; body && i < 8; ++i) body->track(frame, seen, {});
    return body;
  }

 private:
  static constexpr int kHalf = 12;
  /// Down the picture, where nothing nearer is.
  void strip(Vec2 from, double from_z_m, Vec2 to, double to_z_m, int half = kHalf) {
    for (int y = std::max(static_cast<int>(from.y), 0); y <= std::min(static_cast<int>(to.y), 239); ++y) {
      const double t = std::clamp((y - from.y) / std::max(to.y - from.y, 1.0), 0.0, 1.0);
      const int x = static_cast<int>((1 - t) * from.x + t * to.x);
      const std::uint16_t q4 = q4_at((1 - t) * from_z_m + t * to_z_m);
      for (int i = std::max(x - half, 0); i <= std::min(x + half, 319); ++i)
        map.d_q4.at(y, i) = std::max(map.d_q4.at(y, i), q4);
    }
  }
};

/// Sits with thighs of 0.405 m, of which these shares are towards the cameras.
Shown sitting(double left, double right) {
  Places places = standing();
  for (const Limb& leg : kLegChains) {
    const double share = is_left(leg[0]) ? left : right;
    const Vec3 knee = places[leg[0]] + 0.405 * Vec3{0, std::sqrt(1 - share * share), -share};
    const Vec3 moved = knee - places[leg[1]];
    for (const std::size_t n : {1, 2, 3}) places[leg[n]] = places[leg[n]] + moved;
  }
  return {places, {1, 0, 0}};
}

TEST(BodyTurned, AHipBehindItsThighIsNotSeenAndTeachesNothing) {
  const auto state = [](const Shown& shown, const Body& body, JointId id) {
    Person person;
    body.publish(shown.frame, person);
    return person.joints[index_of(id)].state;
  };
  const Lengths adult;
  const Shown half = sitting(0.6, 0.4), upright = sitting(0.4, 0.4);
  const auto one = half.followed(), none = upright.followed();
  ASSERT_TRUE(one && none);
  EXPECT_EQ(state(half, *one, kLeftHip), JointState::kInferred);
  EXPECT_EQ(state(half, *one, kRightHip), JointState::kSeen);
  EXPECT_EQ(state(upright, *none, kLeftHip), JointState::kSeen);
  for (const Bone bone : {Bone::kTrunk, Bone::kHips}) {
    EXPECT_LT(none->lengths().sigma_m(bone), 0.7 * one->lengths().sigma_m(bone));
  }
}

TEST(BodyTurned, FromTheSideHipsAndHeadAreMarkedAhead) {
  // Turned by 45 degrees to either side: what faces the cameras looks to the right of the picture where the left side is away.
  for (const double away : {0.707, -0.707}) {
    Places places = standing();
    for (Vec3& p : places.all) p = {0.707 * p.x - away * (p.z - 2), p.y, 2 + 0.707 * (p.z - 2) + away * p.x};
    Shown shown(places, {0.707, 0, away});
    const double ahead_px = 0.07 * Lengths()[Bone::kShoulders] * away * 200;
    for (const BodyPoint point : {BodyPoint::kLeftEar, BodyPoint::kRightEar, BodyPoint::kLeftHip, BodyPoint::kRightHip})
      shown.move(point, ahead_px, 0);
    const auto body = shown.followed();
    ASSERT_TRUE(body);
    EXPECT_NEAR(body->places()[kHead].x, places[kHead].x, 0.006) << away;
    EXPECT_NEAR(body->places()[kPelvis].x, places[kPelvis].x, 0.006) << away;
  }
}

}  // namespace
}  // namespace duo::body
