#include "trackers/body/limb_samples.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "duoptic/statistics.h"

namespace duo::body {
namespace {

/// A part of a limb, and how wide it may be.
struct LimbPart {
  std::size_t from;  // in the chain
  double least_m, most_m;
};
constexpr LimbPart kArmParts[] = {{0, 0.06, 0.115}, {1, 0.045, 0.095}};
constexpr LimbPart kLegParts[] = {{0, 0.11, 0.22}, {1, 0.08, 0.16}};
constexpr double kShares[] = {0.35, 0.5, 0.65, 0.8};

struct Cut {
  double left = 0, right = 0;  // px from the line, along the normal
  bool has_edges = false;
  double z_m = 0;  // median of its middle
};

/// The run of pixels near the expected depth on a line across the limb.
std::optional<Cut> cut_at(const DepthView& depth, Vec2 at, Vec2 normal, double z, double most_m) {
  constexpr double kNear_m = 0.05;
  constexpr int kMost = 64;
  const double noise = 0.4 * depth.m_per_px(z), reach = most_m * depth.px_per_m(z);
  const int most = std::min(static_cast<int>(reach) + 1, kMost);
  const auto look = [&](int step) -> std::optional<double> {
    const double x = at.x + step * normal.x, y = at.y + step * normal.y;
    if (!(x >= 0 && y >= 0 && x <= depth.d_q4.width() - 1 && y <= depth.d_q4.height() - 1)) return std::nullopt;
    const std::uint16_t q4 = depth.d_q4.at(static_cast<int>(y + 0.5), static_cast<int>(x + 0.5));
    if (q4 == Disparity::kNone || q4 == 0) return 0.0;
    return depth.z_m(q4);
  };
  const auto on_limb = [&](std::optional<double> found) {
    return found && *found > 0 && std::abs(*found - z) < kNear_m + noise;
  };
  if (!on_limb(look(0))) return std::nullopt;
  Cut out;
  std::array<double, 2 * kMost + 1> found;
  std::size_t count = 0;
  bool edges = true;
  for (const int sign : {-1, 1}) {
    int last = 0, step = 1;
    for (; step <= most; ++step) {
      const auto here = look(sign * step);
      if (!here) {
        edges = false;
        break;
      }
      if (on_limb(here))
        last = step;
      else if (step - last > 2)
        break;
    }
    if (step > most) edges = false;
    (sign < 0 ? out.left : out.right) = sign * (last + 0.5);
  }
  out.has_edges = edges;
  const int begin = static_cast<int>(out.left + (out.right - out.left) / 3),
            end = static_cast<int>(out.right - (out.right - out.left) / 3);
  for (int step = begin; step <= end && count < found.size(); ++step)
    if (const auto here = look(step); on_limb(here)) found[count++] = *here;
  if (count == 0) return std::nullopt;
  out.z_m = median(std::span(found.data(), count));
  return out;
}

void sample(const Scene& scene, const Choices& chosen, JointId a, JointId b, const LimbPart& part, LimbSamples& out) {
  constexpr double kDepthSigma_m = 0.024, kCentreSigma_m = 0.02, kDepthSigma_px = 0.35;
  if (!chosen[a].on_surface || !chosen[b].on_surface) return;
  const Vec2 pa = scene.points[a].at_px, pb = scene.points[b].at_px;
  const Vec2 way = {pb.x - pa.x, pb.y - pa.y};
  const double length = std::sqrt(square(way.x) + square(way.y));
  const double z_mean = (chosen[a].p.z + chosen[b].p.z) / 2;
  if (length < 0.08 * scene.depth.px_per_m(z_mean)) return;  // it points at the cameras
  const Vec2 normal = {-way.y / length, way.x / length};
  constexpr double kUpperArm_m = 0.058, kLiftedArm_m = 0.045;  // under the shoulder's muscle
  const double behind_b = depth_of_joint_m(scene, b, z_mean);
  double behind_a = depth_of_joint_m(scene, a, z_mean);
  const double lifted = scene.lifted[is_left(a) ? 0 : 1];
  if (is_shoulder(a)) behind_a = std::min(behind_a, kUpperArm_m + lifted * (kLiftedArm_m - kUpperArm_m));
  for (const double share : kShares) {
    if (out.count == out.all.size()) return;
    const double behind = (1 - share) * behind_a + share * behind_b;
    const double z = (1 - share) * chosen[a].p.z + share * chosen[b].p.z - behind;
    const Vec2 at = {pa.x + share * way.x, pa.y + share * way.y};
    const auto cut = cut_at(scene.depth, at, normal, z, part.most_m);
    if (!cut) continue;
    LimbSample& s = out.all[out.count++];
    s = {a, b, share, cut->z_m + behind, 0, false, at, normal, 0};
    s.z_sigma_m = std::sqrt(square(kDepthSigma_m) + square(kDepthSigma_px * scene.depth.m_per_px(z)));
    const double px_per_m = scene.depth.px_per_m(z), width = (cut->right - cut->left) / px_per_m;
    if (!cut->has_edges || width < part.least_m || width > part.most_m) continue;
    const double middle = (cut->left + cut->right) / 2;
    s.has_edges = true;
    s.middle_px = {at.x + middle * normal.x, at.y + middle * normal.y};
    s.sigma_px = kCentreSigma_m * px_per_m + 0.7;
  }
}

}  // namespace

void sample_limbs(const Scene& scene, const Choices& chosen, LimbSamples& out) {
  out.count = 0;
  for (const Limb& arm : kArmChains)
    for (const LimbPart& part : kArmParts) sample(scene, chosen, arm[part.from], arm[part.from + 1], part, out);
  for (const Limb& leg : kLegChains)
    for (const LimbPart& part : kLegParts) sample(scene, chosen, leg[part.from], leg[part.from + 1], part, out);
}

}  // namespace duo::body
