#include "trackers/body/hidden_by.h"

#include <algorithm>
#include <cmath>

namespace duo::body {
namespace {

/// What a depth may differ by, from one pixel to the next, on one skin.
double step_m(const DepthView& depth, double z_m) {
  constexpr double kStep_m = 0.1, kNoise_px = 0.5;
  return kStep_m + kNoise_px * depth.m_per_px(z_m);
}

/// Depth at a pixel; 0 where it is unknown.
double z_at(const DepthView& depth, int x, int y) {
  if (x < 0 || y < 0 || x >= depth.d_q4.width() || y >= depth.d_q4.height()) return 0;
  const std::uint16_t q4 = depth.d_q4.at(y, x);
  return q4 == Disparity::kNone || q4 == 0 ? 0 : depth.z_m(q4);
}

/// The depth of the skin of one person, along lines of the picture.
class Skin {
 public:
  Skin(const DepthView& depth, double z_m) : depth_(depth), z_m_(z_m) {}
  /// Goes from a place to another.
  void follow(Vec2 from, Vec2 to) {
    const int steps = std::clamp(static_cast<int>(distance(from, to)), 1, 1000);
    for (int i = 0; i <= steps; ++i) {
      const double t = static_cast<double>(i) / steps;
      const double z = z_at(depth_, static_cast<int>(std::lround(from.x + t * (to.x - from.x))),
                            static_cast<int>(std::lround(from.y + t * (to.y - from.y))));
      if (z == 0) continue;
      hidden_ = hides(z);
      if (!hidden_ && z < z_m_ + step_m(depth_, z_m_)) z_m_ = z;
    }
  }
  /// Whether something nearer is at the place where it came to.
  bool hidden() const { return hidden_; }
  bool hides(double z_m) const { return z_m < z_m_ - step_m(depth_, z_m_); }

 private:
  const DepthView& depth_;
  double z_m_;
  bool hidden_ = false;
};

/// How wide the surface is along the row of a place.
double width_m(const DepthView& depth, Vec2 at_px, double z_m, double most_m) {
  constexpr double kNear_m = 0.05, kNoise_px = 0.4;
  constexpr int kMostGap_px = 2;
  const double near_m = kNear_m + kNoise_px * depth.m_per_px(z_m), px_per_m = depth.px_per_m(z_m);
  const int most = static_cast<int>(most_m * px_per_m), x = static_cast<int>(std::lround(at_px.x)),
            y = static_cast<int>(std::lround(at_px.y));
  int width = 1;
  for (const int sign : {-1, 1}) {
    int last = 0;
    for (int step = 1; step <= most && step - last <= kMostGap_px + 1; ++step)
      if (std::abs(z_at(depth, x + sign * step, y) - z_m) < near_m) last = step;
    width += last;
  }
  return width / px_per_m;
}

}  // namespace

void mark_what_hides(Scene& scene) {
  using enum JointId;
  constexpr double kWide_m = 0.33;
  const auto at = [&](JointId id) { return scene.points[id].at_px; };
  const Vec2 chest = mean(at(kLeftShoulder), at(kRightShoulder));
  for (const auto& limbs : {kLegChains, kArmChains})
    for (const Limb& limb : limbs) {
      const bool leg = is_hip(limb[0]);
      Skin skin(scene.depth, scene.trunk_z_m);
      Vec2 from = chest;
      for (const JointId id : limb) {
        if (!scene.points[id].inside) break;
        skin.follow(from, at(id));
        from = at(id);
        Surfaces& surfaces = scene.surfaces[id];
        for (std::size_t i = 0; i < surfaces.count; ++i) {
          Surface& surface = surfaces.all[i];
          surface.hides =
              skin.hidden() && skin.hides(surface.z_m) && (leg || width_m(scene.depth, from, surface.z_m, kWide_m) > kWide_m);
        }
      }
    }
}

}  // namespace duo::body
