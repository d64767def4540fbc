#include "body/bone_turns.h"

#include <Eigen/Geometry>
#include <Eigen/SVD>
#include <algorithm>
#include <array>
#include <cmath>

namespace duo {
namespace {

using Matrix = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;

/// The part of `v` across `along` (of length 1); empty when hardly anything is left.
std::optional<Vec3> across(Vec3 v, Vec3 along) {
  const Vec3 rest = v - dot(v, along) * along;
  constexpr double kLeast = 1e-3;
  if (norm(rest) < kLeast) return std::nullopt;
  return normalized(rest);
}

/// The rotation that takes `rest` to `bone` and `rest_hinge` to `hinge`; both pairs stand upright on each other.
Mat3 turn_to(Vec3 rest, Vec3 rest_hinge, Vec3 bone, Vec3 hinge) {
  return transposed(Mat3::from_rows(bone, hinge, cross(bone, hinge))) *
         Mat3::from_rows(rest, rest_hinge, cross(rest, rest_hinge));
}

/// The rotation that fits directions at rest to those found best.
Mat3 best_fit(std::span<const Vec3> rest, std::span<const Vec3> found) {
  Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
  for (std::size_t i = 0; i < rest.size(); ++i)
    sum += Eigen::Vector3d(found[i].x, found[i].y, found[i].z) * Eigen::RowVector3d(rest[i].x, rest[i].y, rest[i].z);
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(sum, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Eigen::Matrix3d u = svd.matrixU();
  if (u.determinant() * svd.matrixV().determinant() < 0) u.col(2) *= -1;  // no reflection
  Mat3 out;
  Eigen::Map<Matrix>(out.m.data()) = u * svd.matrixV().transpose();
  return out;
}

Side side_of(JointId joint) { return kBodyHands.joints[static_cast<std::size_t>(joint)].side; }

/// A finger of an adult's flat hand: its root from the wrist, along the hand and towards the thumb's side, and its bones.
///
/// Units  metres
struct FlatFinger {
  double along_m, aside_m;
  std::array<double, 3> bones_m;
};
constexpr std::array<FlatFinger, kFingers> kFlatHand = {{{0.025, 0.03, {0.045, 0.034, 0.028}},
                                                         {0.092, 0.025, {0.042, 0.025, 0.02}},
                                                         {0.09, 0.005, {0.046, 0.028, 0.021}},
                                                         {0.085, -0.013, {0.042, 0.027, 0.021}},
                                                         {0.078, -0.03, {0.033, 0.02, 0.018}}}};

/// The bone that ends in a finger's joint, of a flat hand. The thumb stands half aside.
Vec3 flat_bone(JointId id, Vec3 along, Vec3 aside) {
  const auto [finger, joint] = finger_of(id);
  const FlatFinger& flat = kFlatHand[finger];
  if (joint == 0) return flat.along_m * along + flat.aside_m * aside;
  return flat.bones_m[joint - 1] * (finger == 0 ? normalized(along + aside) : along);
}

/// From its parent to a joint of an adult who stands: arms and legs hang down.
///
/// Units  metres
Vec3 hanging(JointId joint, Vec3 up, Vec3 left) {
  using enum JointId;
  const Vec3 side = side_of(joint) == Side::kLeft ? left : -1.0 * left;
  switch (joint) {
    case kHead:
      return 0.18 * up;
    case kLeftElbow:
    case kRightElbow:
      return -0.25 * up;
    case kLeftWrist:
    case kRightWrist:
      return -0.24 * up;
    case kLeftHand:
    case kRightHand:
      return -0.07 * up;
    case kLeftHip:
    case kRightHip:
      return 0.1 * side;
    case kLeftKnee:
    case kRightKnee:
    case kLeftAnkle:
    case kRightAnkle:
      return -0.41 * up;
    case kLeftFoot:
    case kRightFoot:
      return 0.16 * cross(left, up);
    default:
      return 0.1 * up;
  }
}

}  // namespace

// Who looks along z with y up has the left hand at +x when the axes are right-handed, at -x when they are left-handed.
Vec3 rest_direction(JointId joint, BodyAxes axes) {
  const double out = (side_of(joint) == Side::kLeft) == (axes == BodyAxes::kRightHanded) ? 1 : -1;
  if (is_finger(joint)) return normalized(flat_bone(joint, {out, 0, 0}, {0, 0, 1}));
  switch (joint) {
    case JointId::kPelvis:
    case JointId::kSpine:
    case JointId::kChest:
    case JointId::kNeck:
    case JointId::kHead:
      return {0, 1, 0};
    case JointId::kLeftKnee:
    case JointId::kRightKnee:
    case JointId::kLeftAnkle:
    case JointId::kRightAnkle:
      return {0, -1, 0};
    case JointId::kLeftFoot:
    case JointId::kRightFoot:
      return {0, 0, 1};
    default:  // arms, and hips
      return {out, 0, 0};
  }
}

std::optional<std::vector<Vec3>> known_places(const Person& person, const Mat3& axes_from_rig) {
  const auto known = [&](JointId id) {
    const Joint* joint = person.find(id);
    return joint != nullptr && joint->state != JointState::kLost;
  };
  using enum JointId;
  // What carries a joint that is known is no limb that hangs: its place is poor, but goes with those lengths.
  std::vector<bool> carries(person.count());
  for (std::size_t j = person.count(); j-- > 1;)
    if (carries[j] || person.joints[j].state != JointState::kLost)
      carries[static_cast<std::size_t>(person.skeleton->joints[j].parent)] = true;
  const bool has_trunk = std::ranges::all_of(std::array{kPelvis, kSpine, kChest, kLeftShoulder, kRightShoulder}, known);
  std::vector<Vec3> out;
  for (std::size_t j = 0; j < person.count(); ++j) {
    const Joint& joint = person.joints[j];
    const bool lost = joint.state == JointState::kLost;
    if (lost && !has_trunk) return std::nullopt;
    if (!lost || carries[j]) {
      out.push_back(axes_from_rig * joint.p_in_rig_m);
      continue;
    }
    const Vec3 up = person.find(kChest)->p_in_rig_m - person.find(kPelvis)->p_in_rig_m;
    const Vec3 left = person.find(kLeftShoulder)->p_in_rig_m - person.find(kRightShoulder)->p_in_rig_m;
    if (!(norm(up) > 0) || !(norm(cross(left, up)) > 0)) return std::nullopt;
    const JointDef& def = person.skeleton->joints[j];
    const Vec3 from = out[static_cast<std::size_t>(def.parent)];
    if (!is_finger(def.id)) {
      out.push_back(from + axes_from_rig * hanging(def.id, normalized(up), normalized(left)));
      continue;
    }
    // The hand goes on where it points, its thumb to the front.
    const bool is_left = def.side == Side::kLeft;
    const auto at = [&](JointId id) { return out[*person.skeleton->index_of(id)]; };
    const Vec3 hand = at(is_left ? kLeftHand : kRightHand) - at(is_left ? kLeftWrist : kRightWrist);
    const Vec3 y = axes_from_rig * normalized(up), z = axes_from_rig * normalized(cross(left, up));
    const Vec3 along = norm(hand) > 0 ? normalized(hand) : -1.0 * y;
    const auto aside = across(z, along);
    out.push_back(from + flat_bone(def.id, along, aside ? *aside : *across(y, along)));
  }
  return out;
}

BoneTurner::BoneTurner(const Skeleton& skeleton, BodyAxes axes) : nodes_(skeleton.joints.size()) {
  for (std::size_t j = 0; j < nodes_.size(); ++j) {
    const JointDef& joint = skeleton.joints[j];
    nodes_[j].rest = rest_direction(joint.id, axes);
    if (joint.parent >= 0) nodes_[static_cast<std::size_t>(joint.parent)].children.push_back(j);
  }
  for (std::size_t j = 0; j < nodes_.size(); ++j) {
    Node& node = nodes_[j];
    if (node.children.size() != 1) continue;
    const Vec3 bone = nodes_[node.children[0]].rest;
    // An elbow bends the forearm to the front, around y; a knee bends the shin to the back, around x; a finger bends down,
    // where the palm looks, and a thumb beside its root to the fingers.
    const bool arm = bone.x != 0;
    node.hinge_at_rest = arm ? Vec3{0, 1, 0} : Vec3{1, 0, 0};
    Vec3 bend = {0, 0, arm ? 1.0 : -1.0};
    if (const JointId id = skeleton.joints[j].id; is_finger(id)) {
      const bool thumb = finger_of(id).finger == 0;
      bend = thumb ? Vec3{bone.x, 0, -bone.z} : Vec3{0, -1, 0};
      node.hinge_at_rest = thumb ? Vec3{0, 1, 0} : Vec3{0, 0, 1};
    }
    node.hinge = node.hinge_at_rest;
    node.bend_sign = dot(cross(bone, bend), node.hinge_at_rest);
    const bool limb = skeleton.joints[j].side != Side::kMiddle;
    const bool first =
        skeleton.joints[j].parent < 0 || nodes_[static_cast<std::size_t>(skeleton.joints[j].parent)].children.size() > 1;
    node.bends = limb && first && nodes_[node.children[0]].children.size() == 1;
  }
}

std::optional<std::vector<Mat3>> BoneTurner::turn(std::span<const Vec3> places, std::span<const double> lengths) {
  constexpr double kShortest = 1e-6;
  std::vector<Mat3> out(nodes_.size()), whole(nodes_.size());  // whole: from the root's parent
  for (std::size_t j = 0; j < nodes_.size(); ++j)
    for (const std::size_t child : nodes_[j].children)
      if (norm(places[child] - places[j]) < kShortest) return std::nullopt;
  std::vector<Vec3> reached(places.begin(), places.end());  // by the bones
  std::vector<Vec3> bones, rest;
  for (std::size_t j = 0; j < nodes_.size(); ++j) {
    Node& node = nodes_[j];
    bones.clear();
    rest.clear();
    for (const std::size_t child : node.children) {
      Vec3 way = places[child] - reached[j];
      if (norm(way) < kShortest) way = places[child] - places[j];
      const Vec3 bone = transposed(whole[j]) * way;
      bones.push_back(lengths.empty() ? normalized(bone) : bone);
      rest.push_back(lengths.empty() ? nodes_[child].rest : lengths[child] * nodes_[child].rest);
    }
    if (!bones.empty()) out[j] = turn_of(node, bones, rest, whole[j], places);
    for (std::size_t i = 0; i < bones.size(); ++i) {
      const std::size_t child = node.children[i];
      whole[child] = whole[j] * out[j];
      if (!lengths.empty()) reached[child] = reached[j] + whole[child] * rest[i];
    }
  }
  return out;
}

Mat3 BoneTurner::turn_of(Node& node, std::span<const Vec3> bones, std::span<const Vec3> rest, const Mat3& rig_from_parent,
                         std::span<const Vec3> places) {
  if (bones.size() > 1) return best_fit(rest, bones);
  const std::size_t child = node.children[0];
  const Vec3 bone = normalized(bones[0]);
  Vec3 keep = node.hinge_at_rest;
  if (node.bends) {
    const std::size_t end = nodes_[child].children[0];
    const Vec3 lower = transposed(rig_from_parent) * normalized(places[end] - places[child]);
    const Vec3 bend = node.bend_sign * cross(bone, lower);
    constexpr double kStraight = 0.17;  // sine of 10 degrees: below, noise decides where the hinge points
    if (norm(bend) > kStraight) node.hinge = normalized(bend);
    keep = node.hinge;
  }
  // Where the bone lies along the axis that it keeps, its own front stays where it can.
  std::optional<Vec3> hinge = across(keep, bone);
  if (!hinge) hinge = across({0, 0, 1}, bone);
  if (!hinge) hinge = across({1, 0, 0}, bone);
  if (node.bends) node.hinge = *hinge;
  return turn_to(nodes_[child].rest, node.hinge_at_rest, bone, *hinge);
}

std::array<double, 4> quaternion(const Mat3& rotation) {
  const Eigen::Map<const Matrix> matrix(rotation.m.data());
  const Eigen::Quaterniond q = Eigen::Quaterniond(Eigen::Matrix3d(matrix)).normalized();
  const double sign = q.w() < 0 ? -1 : 1;
  return {sign * q.x(), sign * q.y(), sign * q.z(), sign * q.w()};
}

}  // namespace duo
