#include "duoptic/person.h"

#include <algorithm>

namespace duo {

const Joint* Person::find(JointId id_of_joint) const {
  const auto index = skeleton == nullptr ? std::nullopt : skeleton->index_of(id_of_joint);
  return index ? &joints[*index] : nullptr;
}

void Person::sum_up() {
  presence = Presence::kLost;
  confidence = 0;
  double x0 = 0, y0 = 0, x1 = 0, y1 = 0;
  bool any = false;
  for (std::size_t j = 0; j < count(); ++j) {
    const Joint& joint = joints[j];
    confidence += joint.confidence / static_cast<double>(count());
    presence = std::min(presence, static_cast<Presence>(joint.state));
    if (joint.state == JointState::kLost) continue;
    x0 = any ? std::min(x0, joint.u_px) : joint.u_px;
    y0 = any ? std::min(y0, joint.v_px) : joint.v_px;
    x1 = any ? std::max(x1, joint.u_px) : joint.u_px;
    y1 = any ? std::max(y1, joint.v_px) : joint.v_px;
    any = true;
  }
  box_px = {};
  if (!any) return;
  const auto pixel = [](double at_px) {
    constexpr double kFar_px = 1e6;  // a joint beside the cameras projects far outside: no picture reaches there
    return static_cast<int>(std::lround(std::clamp(at_px, -kFar_px, kFar_px)));
  };
  box_px = {pixel(x0), pixel(y0), pixel(x1) - pixel(x0) + 1, pixel(y1) - pixel(y0) + 1};
}

std::optional<Pinch> pinch_of(const Person& person, Side side) {
  const bool left = side == Side::kLeft;
  const Joint* thumb = person.find(left ? JointId::kLeftThumbTip : JointId::kRightThumbTip);
  const Joint* index = person.find(left ? JointId::kLeftIndexTip : JointId::kRightIndexTip);
  if (thumb == nullptr || index == nullptr || thumb->state == JointState::kLost || index->state == JointState::kLost) return {};
  if (thumb->state != JointState::kSeen && index->state != JointState::kSeen) return {};
  const Vec3 way = index->p_in_rig_m - thumb->p_in_rig_m;
  const double distance = norm(way);
  const Vec3 u = distance > 0 ? (1 / distance) * way : Vec3{1, 0, 0};
  const auto along = [u](const Covariance3& c) {
    return u.x * u.x * c.xx + u.y * u.y * c.yy + u.z * u.z * c.zz +
           2 * (u.x * u.y * c.xy + u.x * u.z * c.xz + u.y * u.z * c.yz);
  };
  return Pinch{distance, std::sqrt(std::max(along(thumb->cov_m2) + along(index->cov_m2), 0.0))};
}

}  // namespace duo
