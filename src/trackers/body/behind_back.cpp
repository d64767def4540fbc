#include "trackers/body/behind_back.h"

#include "trackers/body/candidates.h"

namespace duo::body {
namespace {

constexpr double kHalfWrist_m = 0.03;

}  // namespace

std::optional<double> Scene::off_back_m(JointId id, Vec3 p) const {
  constexpr double kHalfWidths = 0.6, kAbove = 0.1, kBelow = 1.3;  // the back: of the trunk's width and length
  constexpr double kFacing = 0.7;
  if (!is_hand_or_wrist(id) || sight_of(id) != HandSight::kAbsent) return std::nullopt;
  if (dot(trunk.front, normalized(trunk.shoulders)) > -kFacing) return std::nullopt;
  const Vec3 q = trunk.of(p);
  if (std::abs(q.x) > kHalfWidths * trunk.width_m || q.y < kAbove * trunk.length_m || q.y > kBelow * trunk.length_m || q.z > 0)
    return std::nullopt;
  return -q.z - default_height_m(trunk, q.y, width_m()) - kHalfWrist_m;
}

std::optional<Vec3> on_back(const Scene& scene, JointId wrist, Vec3 elbow, double length) {
  constexpr double kLeastWay_m = 0.04;  // a mark nearer to the elbow shows no direction
  if (scene.sight_of(wrist) != HandSight::kAbsent) return std::nullopt;
  const TrunkAxes& trunk = scene.trunk;
  const Vec3 ray = on_ray(scene, wrist, 1), from = trunk.of(elbow);
  const double back = -default_height_m(trunk, from.y, scene.width_m()) - kHalfWrist_m;
  const double towards = dot(ray, trunk.front), off = from.z - back;
  if (towards > -0.1 || std::abs(off) >= length) return std::nullopt;
  const Vec3 marked = trunk.of(((back + dot(trunk.shoulders, trunk.front)) / towards) * ray);
  const Vec3 way = {marked.x - from.x, marked.y - from.y, 0};
  if (norm(way) < kLeastWay_m) return std::nullopt;
  const Vec3 p = Vec3{from.x, from.y, back} + std::sqrt(square(length) - square(off)) * normalized(way);
  const Vec3 in_rig = trunk.in_rig(p);
  return scene.off_back_m(wrist, in_rig) ? std::optional(in_rig) : std::nullopt;
}

}  // namespace duo::body
