#include "trackers/arm/hand.h"

#include <algorithm>
#include <cmath>

#include "duoptic/statistics.h"

namespace duo::arm {

namespace {

/// Calls each(cell, place) for some places just beyond the fingertips; cell is -1 outside of the picture.
template <class Each>
void each_beyond(const Grid& grid, Vec3 elbow, const HandSeen& hand, Each&& each) {
  const Vec3 way = normalized(hand.p - elbow), side = normalized(cross(way, hand.p));
  for (const double beyond_m : {0.02, 0.035, 0.05})
    for (const double aside_m : {-0.02, 0.0, 0.02}) {
      const Vec3 p = elbow + (hand.tip_m + beyond_m) * way + aside_m * side;
      each(grid.cell_of(p), p);
    }
}

double cut_beyond(const Grid& grid, Vec3 elbow, const HandSeen& hand) {
  int cut = 0, all = 0;
  each_beyond(grid, elbow, hand, [&](int i, Vec3) {
    ++all;
    cut += i < 0 || !grid.inside[static_cast<std::size_t>(i)];
  });
  return cut / static_cast<double>(all);
}

}  // namespace

HandFinder::HandFinder(const Grid& grid) {
  far_.reserve(static_cast<std::size_t>(grid.size()));
  depths_m_.reserve(static_cast<std::size_t>(grid.size()));
}

/// The distance from the elbow that this share of the gathered cells lies within.
double HandFinder::distance_within(double share) {
  const auto at = far_.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(far_.size() - 1));
  std::nth_element(far_.begin(), at, far_.end(), [](const Far& a, const Far& b) { return a.distance_m < b.distance_m; });
  return at->distance_m;
}

/// Gathers the cells a hand may cover; returns the distance of the tips, which single far cells do not move. 0 = too few.
double HandFinder::collect(const Grid& grid, std::span<const int> cells, Vec3 elbow, double fore_m, const Gate* gate) {
  constexpr double kBeyondM = 0.30;  // fingertips lie this far behind the wrist at most
  constexpr std::size_t kLeastCells = 10;
  constexpr double kTips = 0.97;  // quantile of distance
  far_.clear();
  for (const int i : cells) {
    const Vec3 p = grid.point(i);
    if (gate && norm(p - gate->centre) > gate->radius_m) continue;
    if (const double d = norm(p - elbow); d <= fore_m + kBeyondM) far_.push_back({d, p, i});
  }
  return far_.size() < kLeastCells ? 0 : distance_within(kTips);
}

/// From the elbow to the hand's centre. A stretched hand's lies centre_m behind the tips; one bent at the wrist, or a fist,
/// reaches less far, but its centre is no nearer to where a sleeve lets it out than a palm is long.
double HandFinder::along(double tip_m, double centre_m, double palm_m) {
  constexpr double kSleeve = 0.05;    // quantile of distance; of a bare arm, far behind the wrist
  constexpr double kFingersM = 0.03;  // before the centre at least
  return std::max(tip_m - centre_m, std::min(distance_within(kSleeve) + palm_m, tip_m - kFingersM));
}

double HandFinder::median_of_depths() { return median(depths_m_); }

/// Mean shift of a slab across the arm, `along_m` from the elbow; its depth is the median there.
Vec3 HandFinder::centre(Vec3 elbow, Vec3 start, double along_m, double z_m) {
  constexpr int kShifts = 2;
  constexpr double kSlabM = 0.04, kAcrossM = 0.07, kDepthM = 0.12;
  constexpr std::size_t kLeastCells = 6;
  Vec3 axis = normalized(start - elbow), at = elbow + along_m * axis;
  for (int shift = 0; shift < kShifts; ++shift) {
    Vec3 mean;
    double weights = 0;
    depths_m_.clear();
    for (const Far& f : far_) {
      const double along = dot(f.p - at, axis);
      if (std::abs(f.p.z - z_m) > kDepthM || std::abs(along) > kSlabM || norm(f.p - at - along * axis) > kAcrossM) continue;
      const double weight = f.p.z * f.p.z;  // a cell covers more of the hand where it is far
      mean = mean + weight * f.p;
      weights += weight;
      depths_m_.push_back(f.p.z);
    }
    if (depths_m_.size() < kLeastCells) break;
    mean = (1 / weights) * mean;
    const double z = median_of_depths();
    const Vec3 across = mean - dot(mean - at, axis) * axis;
    axis = normalized((z / across.z) * across - elbow);
    at = elbow + along_m * axis;
    at = (z / at.z) * at;
  }
  return at;
}

std::optional<HandSeen> HandFinder::find(const Grid& grid, const Silhouette& silhouette, std::span<const int> cells, Vec3 elbow,
                                         double fore_m, double centre_m, const Gate* gate, const Params& params) {
  constexpr double kBeyondTipM = 0.03;
  constexpr std::size_t kLeastCells = 8;
  HandSeen out;
  out.tip_m = collect(grid, cells, elbow, fore_m, gate);
  if (!(out.tip_m > 0)) return {};
  Vec3 mean;
  double weights = 0;
  depths_m_.clear();
  for (const Far& f : far_) {
    if (f.distance_m < out.tip_m - params.hand_length_m || f.distance_m > out.tip_m + kBeyondTipM) continue;
    const double weight = f.p.z * f.p.z, area = grid.area_m2(f.p.z);
    mean = mean + weight * f.p;
    weights += weight;
    depths_m_.push_back(f.p.z);
    out.area_m2 += area;
    if (silhouette.solid[static_cast<std::size_t>(f.cell)]) out.solid_m2 += area;
    if (silhouette.skin[static_cast<std::size_t>(f.cell)]) out.skin_m2 += area;
  }
  if (depths_m_.size() < kLeastCells) return {};
  const Vec3 start = (1 / weights) * mean;
  const double z_m = median_of_depths(), along_m = along(out.tip_m, centre_m, params.palm_m);
  out.p = behind(centre(elbow, start, along_m, z_m), params.hand_depth_m);
  out.cut = cut_beyond(grid, elbow, out);
  return out;
}

double covered_beyond(const Grid& grid, const std::vector<std::uint8_t>& front, Vec3 elbow, const HandSeen& hand,
                      const Params& params) {
  constexpr double kNearerM = 0.05;
  int covered = 0, all = 0;
  each_beyond(grid, elbow, hand, [&](int i, Vec3 p) {
    if (i < 0) return;
    ++all;
    covered += grid.known(i) && front[static_cast<std::size_t>(i)] &&
               grid.z(i) < p.z - kNearerM - grid.z_sigma_m(p.z, params.disparity_sigma_px);
  });
  return all > 0 ? covered / static_cast<double>(all) : 0;
}

}  // namespace duo::arm
