#include "trackers/arm/silhouette.h"

#include <algorithm>
#include <cmath>

namespace duo::arm {
namespace {

void clear(std::vector<std::uint8_t>& mask) { std::fill(mask.begin(), mask.end(), std::uint8_t{0}); }

bool near_other(std::span<const OtherSkin> others, Vec3 p, Vec3 hand) {
  constexpr double kHeadM = 0.16, kHandM = 0.13, kBeforeM = 0.09;
  constexpr int kForgotten = 20;  // frames
  return std::any_of(others.begin(), others.end(), [&](const OtherSkin& o) {
    const Vec3 q = p - o.p;
    return o.unseen < kForgotten && norm(q) < (o.head ? kHeadM : kHandM) && q.z > -kBeforeM && norm(q) < norm(p - hand);
  });
}

}  // namespace

Silhouette::Silhouette(const Grid& grid) : regions_(grid) {
  for (auto* mask : {&front, &any_skin, &skin, &solid, &body, &scratch_}) mask->resize(static_cast<std::size_t>(grid.size()));
}

void Silhouette::find(const SilhouetteInput& in, const Params& params) {
  find_front(in);
  find_skin(in, params);
  find_solid(in.grid);
}

void Silhouette::find_front(const SilhouetteInput& in) {
  constexpr double kBodyM = 0.7;  // beyond the arm's reach: the rest of the body
  constexpr double kStepM = 0.03, kLeastM2 = 0.004;
  for (int i = 0; i < in.grid.size(); ++i) {
    const auto k = static_cast<std::size_t>(i);
    scratch_[k] =
        in.grid.inside[k] && in.background.front(in.grid, i) && norm(in.grid.point(i) - in.shoulder) < in.reach_m + kBodyM;
  }
  clear(front);
  clear(body);
  for (const Region& r : regions_.find(in.grid, scratch_, kStepM)) {
    if (r.area_m2 <= kLeastM2) continue;
    for (const int i : r.cells) {
      front[static_cast<std::size_t>(i)] = 1;
      body[static_cast<std::size_t>(i)] = in.body.holds(in.torso_from_rig * in.grid.point(i));
    }
  }
}

void Silhouette::find_skin(const SilhouetteInput& in, const Params& params) {
  constexpr double kSlackM = 0.20;  // fingertips beyond the hand's centre, and the shoulder's own error
  constexpr double kOwnM = 0.13;    // around a hand that was just seen, body or not
  constexpr int kMajority = 5;
  clear(any_skin);
  clear(skin);
  for (int i = 0; i < in.grid.size(); ++i) {
    const auto k = static_cast<std::size_t>(i);
    if (!front[k] || in.colors(in.grid.color_bin(i)) < params.least_skin) continue;
    const Vec3 p = in.grid.point(i);
    if (norm(p - in.shoulder) > in.reach_m + kSlackM) continue;
    any_skin[k] = 1;
    const bool own = in.hand_seen && norm(p - in.hand) <= kOwnM;
    skin[k] = (own || !in.body_skin.holds_nearby(in.torso_from_rig * p)) && !near_other(in.others, p, in.hand);
  }
  keep_majority(in.grid, skin, scratch_, kMajority);
}

void Silhouette::find_solid(const Grid& grid) {
  constexpr double kRadiusM = 0.010, kShare = 0.75;
  clear(solid);
  for (int i = 0; i < grid.size(); ++i) {
    if (!skin[static_cast<std::size_t>(i)]) continue;
    const int r = std::max(1, static_cast<int>(std::lround(kRadiusM * grid.camera.focal_px / grid.z(i))));
    int set = 0;
    each_around(grid, i % grid.width, i / grid.width, r, [&](int j) { set += skin[static_cast<std::size_t>(j)]; });
    solid[static_cast<std::size_t>(i)] = set >= kShare * (2 * r + 1) * (2 * r + 1);
  }
}

}  // namespace duo::arm
