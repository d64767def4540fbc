#include "trackers/body/behind_back.h"

#include <algorithm>

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

std::optional<double> Scene::off_hanging_m(JointId id, Vec3 p, Vec3 shoulder) const {
  // Chosen on the shared clips, their copies and synthetic ones of seeds 501 and 502: there they hang 2 to 9 cm out.
  constexpr double kFromSide = 0.55, kElbowOut_m = 0.045, kHandOut_m = 0.06;
  const double away = is_left(id) ? trunk.across.z : -trunk.across.z;
  if (!is_arm(id) || away < kFromSide) return std::nullopt;
  const double out = dot(p - shoulder, trunk.across);
  return (is_left(id) ? out : -out) - (is_hand_or_wrist(id) ? kHandOut_m : kElbowOut_m);
}

void leave_upper_arm(Scene& scene, const Limb& arm) {
  constexpr double kHalfUpperArm_m = 0.05;
  if (!scene.off_back_m(arm[2], scene.expected[arm[2]].p)) return;
  const auto marked = [&](std::size_t i) { return scene.points[arm[i]].at_px; };
  const double near_px = kHalfUpperArm_m * scene.depth.px_per_m(std::max(scene.expected[arm[1]].p.z, kAnyDepth.near_m));
  if (to_segment(marked(2), marked(0), marked(1)) > near_px) return;
  const View<const std::uint16_t> map = scene.depth.d_q4;
  for (const JointId id : {arm[2], arm[3]}) {
    const Vec3 p = scene.expected[id].p;
    const Vec2 at = scene.depth.geometry->project({p.x, p.y, std::max(p.z, kAnyDepth.near_m)});
    scene.points[id].at_px = at;
    scene.points[id].inside = at.x >= 0 && at.y >= 0 && at.x <= map.width() - 1 && at.y <= map.height() - 1;
    scene.points[id].hide();
  }
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
