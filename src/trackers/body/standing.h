// A made-up person for the tests of the steps: where its joints are, and a scene that shows each of them.
#pragma once

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <utility>

#include "duoptic/detector.h"
#include "trackers/body/fit.h"

namespace duo::body::test {

using enum JointId;

/// 400 px focal length, 0.1 m baseline: 40 m px.
inline Rectified geometry() {
  Rectified out;
  static_cast<Pinhole&>(out) = {400, 160, 120, 0.1};
  out.size = {320, 240};
  return out;
}

inline std::uint16_t q4_at(double z_m) {
  return static_cast<std::uint16_t>(std::lround(16 * (40 / z_m - DepthView::kShort_px)));
}

struct Map {
  Rectified geometry_ = geometry();
  Image<std::uint16_t> d_q4 = Image<std::uint16_t>({320, 240});
  Map() { fill({0, 0, 320, 240}, 0); }
  void fill(Window window, double z_m) {
    for (int y = window.y; y < window.y_end(); ++y)
      for (int x = window.x; x < window.x_end(); ++x) d_q4.at(y, x) = z_m > 0 ? q4_at(z_m) : Disparity::kNone;
  }
  DepthView view() const { return {d_q4.view(), &geometry_}; }
};

/// A person 2 m away who faces the camera, arms hanging a little apart.
inline Places standing() {
  Places p;
  p[kHead] = {0, -0.71, 2};
  for (const double side : {1.0, -1.0}) {
    const bool left = side > 0;
    const auto& arm = kArmChains[left ? 0 : 1];
    const auto& leg = kLegChains[left ? 0 : 1];
    p[arm[0]] = {side * 0.1725, -0.425, 2};
    p[arm[1]] = {side * 0.22, -0.178, 2};
    p[arm[2]] = {side * 0.25, 0.058, 2};
    p[arm[3]] = {side * 0.255, 0.126, 2};
    p[leg[0]] = {side * 0.105, 0.035, 2};
    p[leg[1]] = {side * 0.11, 0.44, 2};
    p[leg[2]] = {side * 0.115, 0.855, 2};
    p[leg[3]] = {side * 0.14, 0.9, 1.85};
  }
  complete(p);
  return p;
}

/// What the network of bodies says of somebody of whom everything shows, each joint marked at its centre.
inline SeenBody marks_of(const Places& places) {
  constexpr std::pair<BodyPoint, JointId> kMarks[] = {
      {BodyPoint::kNose, kHead},
      {BodyPoint::kLeftEar, kHead},
      {BodyPoint::kRightEar, kHead},
      {BodyPoint::kLeftShoulder, kLeftShoulder},
      {BodyPoint::kRightShoulder, kRightShoulder},
      {BodyPoint::kLeftElbow, kLeftElbow},
      {BodyPoint::kRightElbow, kRightElbow},
      {BodyPoint::kLeftWrist, kLeftWrist},
      {BodyPoint::kRightWrist, kRightWrist},
      {BodyPoint::kLeftIndex, kLeftHand},
      {BodyPoint::kRightIndex, kRightHand},
      {BodyPoint::kLeftPinky, kLeftHand},
      {BodyPoint::kRightPinky, kRightHand},
      {BodyPoint::kLeftHip, kLeftHip},
      {BodyPoint::kRightHip, kRightHip},
      {BodyPoint::kLeftKnee, kLeftKnee},
      {BodyPoint::kRightKnee, kRightKnee},
      {BodyPoint::kLeftAnkle, kLeftAnkle},
      {BodyPoint::kRightAnkle, kRightAnkle},
  };
  const Rectified camera = geometry();
  SeenBody out;
  for (const auto& [point, joint] : kMarks) {
    SeenPoint& mark = out.points[static_cast<std::size_t>(point)];
    const Vec2 at = camera.project(places[joint]);
    const Vec3 world = places[joint] - places[kPelvis];
    mark.x_q8 = static_cast<std::int32_t>(256 * at.x), mark.y_q8 = static_cast<std::int32_t>(256 * at.y);
    mark.world_q16 = {static_cast<std::int32_t>(65536 * world.x), static_cast<std::int32_t>(65536 * world.y),
                      static_cast<std::int32_t>(65536 * world.z)};
    mark.visible_q15 = mark.present_q15 = 32768;
  }
  out.next = {160 * 256, 120 * 256, 128 * 256, 0};
  return out;
}

/// A scene in which every joint is seen on a surface of its own at its depth, and expected where it is.
struct Standing {
  Rectified geometry_ = geometry();
  Image<std::uint16_t> d_q4 = Image<std::uint16_t>({320, 240});
  Lengths lengths;
  SurfaceMap map;
  Scene scene;
  explicit Standing(const Places& places, Vec3 across = {1, 0, 0}) {
    scene.depth = {d_q4.view(), &geometry_};
    scene.lengths = &lengths;
    scene.map = &map;
    scene.across = {across, across};
    scene.trunk = trunk_axes(places);
    scene.trunk_z_m = 2;
    for (const JointId id : kFreeJoints) {
      scene.points[id] = {geometry_.project(places[id]), 1.5, 1, true};
      scene.expected[id] = {places[id], 0.03, 0};
      double skin = places[id].z;
      for (int i = 0; i < 4; ++i) skin = places[id].z - depth_of_joint_m(scene, id, skin);
      put(id, {{skin, 1}});
    }
  }
  void put(JointId id, std::initializer_list<Surface> surfaces) {
    Surfaces& at = scene.surfaces[id];
    at.count = surfaces.size();
    std::copy(surfaces.begin(), surfaces.end(), at.all.begin());
  }
};

}  // namespace duo::body::test
