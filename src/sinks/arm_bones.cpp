#include "sinks/arm_bones.h"

#include <Eigen/Geometry>
#include <cmath>

namespace duo {
namespace {

/// The part of `v` across `along` (of length 1); empty when hardly anything is left.
std::optional<Vec3> across(Vec3 v, Vec3 along) {
  const Vec3 rest = v - dot(v, along) * along;
  constexpr double kLeast = 1e-3;
  if (norm(rest) < kLeast) return std::nullopt;
  return normalized(rest);
}

/// The rotation that takes (x, 0, 0) to `bone` and y to `hinge`, which stand upright on each other.
Mat3 turn_to(double x, Vec3 bone, Vec3 hinge) { return transposed(Mat3::from_rows(x * bone, hinge, x * cross(bone, hinge))); }

}  // namespace

// Who looks along z with y up has the left hand at +x when the axes are right-handed, at -x when they are left-handed.
double rest_x(ArmSide side, bool left_handed) { return (side == ArmSide::kLeft) != left_handed ? 1 : -1; }

ArmSide side_of(ArmSide first, std::size_t arm) {
  return arm % 2 == 0 ? first : first == ArmSide::kRight ? ArmSide::kLeft : ArmSide::kRight;
}
std::string_view side_name(ArmSide side) { return side == ArmSide::kLeft ? "Left" : "Right"; }

std::optional<BoneTurns> ArmTurner::turn(Vec3 shoulder, Vec3 elbow, Vec3 hand) {
  constexpr double kShortest = 1e-6;
  if (norm(elbow - shoulder) < kShortest || norm(hand - elbow) < kShortest) return std::nullopt;
  const Vec3 upper = normalized(elbow - shoulder), lower = normalized(hand - elbow);
  // At rest the bone is (x, 0, 0) and bends towards z: cross(bone, z) = -x * y, so the hinge is -x * cross(upper, lower).
  const Vec3 bend = -rest_x_ * cross(upper, lower);
  constexpr double kStraight = 0.17;  // sine of 10 degrees: below, noise decides where the hinge points
  if (norm(bend) > kStraight) hinge_ = normalized(bend);
  Vec3 hinge = across(hinge_, upper).value_or(Vec3{});
  if (norm(hinge) == 0) hinge = across({0, 0, 1}, upper).value_or(Vec3{1, 0, 0});
  hinge_ = hinge;

  const Mat3 to_upper = turn_to(rest_x_, upper, hinge);
  // The smallest turn from the upper bone to the lower one: around the hinge, but for what a straight arm's noise adds.
  const Vec3 lower_in_upper = transposed(to_upper) * lower;
  const Vec3 lower_hinge = across({0, 1, 0}, lower_in_upper).value_or(Vec3{0, 0, 1});
  return BoneTurns{to_upper, turn_to(rest_x_, lower_in_upper, lower_hinge)};
}

std::array<double, 4> quaternion(const Mat3& rotation) {
  const Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>> matrix(rotation.m.data());
  const Eigen::Quaterniond q = Eigen::Quaterniond(Eigen::Matrix3d(matrix)).normalized();
  const double sign = q.w() < 0 ? -1 : 1;
  return {sign * q.x(), sign * q.y(), sign * q.z(), sign * q.w()};
}

}  // namespace duo
