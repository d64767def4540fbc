#include "sources/synthetic/blend.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include "core/check.h"

namespace duo::synthetic {
namespace {

constexpr double kNone = std::numeric_limits<double>::infinity();
constexpr std::size_t kMaxLobes = 32;

// Source  Quilez, "Smooth minimum", 2013 (quadratic)
double soft_min(double a, double b, double soft_m) {
  const double h = std::max(soft_m - std::abs(a - b), 0.0) / soft_m;
  return std::min(a, b) - 0.25 * h * h * soft_m;
}

}  // namespace

Blend::Blend(std::vector<Lobe> lobes) {
  DUO_CHECK(!lobes.empty() && lobes.size() <= kMaxLobes);
  for (const Lobe& lobe : lobes) {
    Placed placed;
    placed.lobe = lobe;
    placed.lobe_from_blend = transposed(lobe.blend_from_lobe.rotation);
    if (lobe.length_m > 0) placed.slope = (lobe.from_m - lobe.to_m) / lobe.length_m;
    placed.across = std::sqrt(std::max(0.0, 1 - placed.slope * placed.slope));
    placed.centre_m = lobe.blend_from_lobe * Vec3{0, lobe.length_m / 2, 0};
    placed.start_m = lobe.blend_from_lobe.t_m;
    placed.way_m = lobe.blend_from_lobe.rotation * Vec3{0, lobe.length_m, 0};
    placed.radius_m = std::max(lobe.from_m, lobe.to_m) / std::min(lobe.flat, 1.0);
    placed.reach_m = lobe.length_m / 2 + placed.radius_m;
    const auto grow = [](double& half, double centre, double reach) { half = std::max(half, std::abs(centre) + reach); };
    // Both end balls; a seam bulges by a quarter of its softness at most.
    for (const auto& [y, radius] : {std::pair{0.0, lobe.from_m}, std::pair{lobe.length_m, lobe.to_m}}) {
      const Vec3 end = lobe.blend_from_lobe * Vec3{0, y, 0};
      const double reach = radius / std::min(lobe.flat, 1.0) + 0.5 * lobe.soft_m;
      grow(half_m_.x, end.x, reach);
      grow(half_m_.y, end.y, reach);
      grow(half_m_.z, end.z, reach);
    }
    lobes_.push_back(placed);
  }
  double margin = 0;
  for (auto it = lobes_.rbegin(); it != lobes_.rend(); ++it) it->margin_m = margin = std::max(margin, it->lobe.soft_m);
}

// The distance to a round cone; squeezed along z it is right to first order, by the length of its gradient.
// Source  Quilez, "Round cone" and "Ellipsoid" in "Distance functions", 2008
double Blend::Placed::distance(Vec3 p_in_blend) const {
  const Vec3 p = lobe_from_blend * (p_in_blend - lobe.blend_from_lobe.t_m);
  const double z = p.z * lobe.flat, r = std::sqrt(p.x * p.x + z * z);
  const double along = lobe.length_m > 0 ? across * p.y - slope * r : (p.y < 0 ? -1.0 : 1.0);
  double d, out_r, out_y;  // distance and its gradient
  if (along < 0 || along > across * lobe.length_m) {
    const double y = along < 0 ? p.y : p.y - lobe.length_m, to_end = std::sqrt(r * r + y * y);
    d = to_end - (along < 0 ? lobe.from_m : lobe.to_m);
    out_r = r, out_y = y;
    if (lobe.flat != 1 && to_end > 0) out_r /= to_end, out_y /= to_end;
  } else {
    d = across * r + slope * p.y - lobe.from_m;
    out_r = across, out_y = slope;
  }
  if (lobe.flat != 1 && r > 0) {
    const double per_r = out_r / r, gx = per_r * p.x, gz = lobe.flat * per_r * z;
    d /= std::sqrt(std::max(gx * gx + out_y * out_y + gz * gz, 0.01));
  }
  return std::max(d, p.y - lobe.cut_m);
}

struct Blend::Near {
  std::array<std::uint8_t, kMaxLobes> which;
  int count = 0;
  double in = kNone, out = -kNone;
  void add(std::size_t lobe) { which[count++] = static_cast<std::uint8_t>(lobe); }
};

double Blend::distance(Vec3 p, const Near& near) const {
  double d = kNone;
  for (int i = 0; i < near.count; ++i) {
    const Placed& placed = lobes_[near.which[i]];
    // Farther away than the seam is soft it changes nothing.
    const Vec3 off = p - placed.centre_m;
    const double far = d + placed.lobe.soft_m + placed.reach_m;
    if (d != kNone && far > 0 && dot(off, off) > far * far) continue;
    const double next = placed.distance(p);
    d = d == kNone ? next : soft_min(d, next, placed.lobe.soft_m);
  }
  return d;
}

// The lobes that the ray passes near enough to change something.
Blend::Near Blend::near(Vec3 origin, Vec3 direction, double t_min, double t_max) const {
  Near out;
  const double speed2 = dot(direction, direction), inverse = 1 / speed2;
  const auto across = [&](Vec3 v) { return v - (dot(v, direction) * inverse) * direction; };
  for (std::size_t i = 0; i < lobes_.size(); ++i) {
    const Placed& lobe = lobes_[i];
    const Vec3 to_centre = lobe.centre_m - origin;
    const double reach = lobe.reach_m + lobe.margin_m, middle = dot(to_centre, direction) * inverse;
    const double half2 = (reach * reach - dot(to_centre, to_centre)) * inverse + middle * middle;
    if (half2 < 0) continue;
    const Vec3 start = across(lobe.start_m - origin), way = across(lobe.way_m);
    const double ways = dot(way, way), share = ways > 0 ? std::clamp(-dot(start, way) / ways, 0.0, 1.0) : 0;
    const Vec3 nearest = start + share * way;
    const double radius = lobe.radius_m + lobe.margin_m;
    if (dot(nearest, nearest) > radius * radius) continue;
    const double half = std::sqrt(half2);
    if (middle + half <= t_min || middle - half >= t_max) continue;
    out.add(i);
    out.in = std::min(out.in, middle - half);
    out.out = std::max(out.out, middle + half);
  }
  out.in = std::max(out.in, t_min);
  out.out = std::min(out.out, t_max);
  return out;
}

double Blend::enter(Vec3 origin, Vec3 direction, double t_min) const {
  constexpr double kClose_m = 2e-6, kFlat_m = 3e-3;
  constexpr int kMaxSteps = 240;  // a ray that grazes one lobe on its way to the next needs many
  const Near near = this->near(origin, direction, t_min, kNone);
  if (near.count == 0) return kNone;
  const double per_m = 1 / norm(direction);
  double t = near.in, before = 0, step_m = 0;
  if (t == t_min && distance(origin + t * direction, near) < 0) return kNone;  // starts inside
  for (int i = 0; i < kMaxSteps && t <= near.out; ++i) {
    const double d = distance(origin + t * direction, near);
    if (std::abs(d) < kClose_m) return t > t_min ? t : kNone;
    // Close by, the surface is nearly flat: as fast as the last step brought it nearer, so will the next. A step too far, here
    // or because a squeezed lobe tells a little too much, is taken back.
    const double rate = std::abs(d) < kFlat_m && step_m != 0 ? std::clamp((before - d) / step_m, 0.4, 1.0) : 1.0;
    before = d;
    step_m = d / rate;
    t += step_m * per_m;
  }
  return kNone;
}

bool Blend::blocks(Vec3 origin, Vec3 direction) const {
  constexpr double kClose_m = 3e-4, kLeast_m = 3e-3;
  const Near near = this->near(origin, direction, 0, 1);
  if (near.count == 0) return false;
  const double per_m = 1 / norm(direction);
  double d = near.in == 0 ? distance(origin, near) : 0;
  if (d < 0) return false;  // starts inside
  for (double t = near.in + std::max(d, kLeast_m) * per_m; t <= near.out; t += std::max(d, kLeast_m) * per_m) {
    d = distance(origin + t * direction, near);
    if (d < kClose_m) return true;
  }
  return false;
}

Vec3 Blend::normal(Vec3 p) const {
  constexpr double kStep_m = 3e-4;
  Near near;
  for (std::size_t i = 0; i < lobes_.size(); ++i) {
    const Vec3 off = p - lobes_[i].centre_m;
    const double reach = lobes_[i].reach_m + lobes_[i].margin_m;
    if (dot(off, off) < reach * reach) near.add(i);
  }
  // Differences along the corners of a tetrahedron.
  Vec3 sum;
  for (const Vec3 corner : {Vec3{1, -1, -1}, Vec3{-1, -1, 1}, Vec3{-1, 1, -1}, Vec3{1, 1, 1}})
    sum = sum + distance(p + kStep_m * corner, near) * corner;
  const double length = norm(sum);
  return length > 0 ? (1 / length) * sum : Vec3{0, -1, 0};
}

Vec3 Blend::at_rest(Vec3 p) const {
  constexpr double kFade_m = 0.03;
  std::array<double, kMaxLobes> distances;
  double nearest = kNone;
  for (std::size_t i = 0; i < lobes_.size(); ++i) nearest = std::min(nearest, distances[i] = lobes_[i].distance(p));
  Vec3 sum;
  double weights = 0;
  for (std::size_t i = 0; i < lobes_.size(); ++i) {
    const double w = std::max(0.0, 1 - (distances[i] - nearest) / kFade_m), weight = w * w;
    if (weight == 0) continue;
    const Placed& placed = lobes_[i];
    sum = sum + weight * (placed.lobe.rest_from_lobe * (placed.lobe_from_blend * (p - placed.lobe.blend_from_lobe.t_m)));
    weights += weight;
  }
  return (1 / weights) * sum;
}

}  // namespace duo::synthetic
