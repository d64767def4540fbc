#include "sources/synthetic/script.h"

#include <algorithm>
#include <cmath>

#include "sources/synthetic/noise.h"

namespace duo::synthetic {
namespace {

const ArmPose kHanging{{0.085, 0.53, -0.05}, {0.4, 0, 1}, {-0.6, 0, 0.8}, {}, 20};

// From rest and back to it, with a pause at either end.
std::vector<WayPoint> from_rest(std::vector<WayPoint> between, double length_s) {
  constexpr double kStart_s = 0.3, kEnd_s = 0.15;
  std::vector<WayPoint> way = {{0, kHanging}, {kStart_s, kHanging}};
  way.insert(way.end(), between.begin(), between.end());
  way.push_back({length_s - kEnd_s, kHanging});
  way.push_back({length_s, kHanging});
  return way;
}

Act wave() {
  const Vec3 palm{0, 0, -1}, elbow{1, 1, 0.2};
  const ArmPose out{{0.34, -0.1, -0.2}, elbow, palm, {0.25, -0.1, 0}, 8},
      in{{0.13, -0.14, -0.2}, elbow, palm, {-0.25, -0.1, 0}, 8};
  return {"wave", from_rest({{0.95, out}, {1.22, in}, {1.49, out}, {1.76, in}, {2.03, out}}, 2.9)};
}

Act reach() {
  const ArmPose near{{-0.04, 0.17, -0.47}, {0.7, 1, 0}, {0, 0.2, -1}, {0, -0.9, 0}, 8};
  const ArmPose held{{0.02, 0.19, -0.44}, {0.7, 1, 0}, {0, 0.2, -1}, {0, -0.9, 0}, 8};
  return {"reach", from_rest({{1.1, near, -10}, {1.5, held, -8}}, 2.5)};
}

Act sweep() {
  const Vec3 elbow{0.4, 1, 0.3};
  const ArmPose side{{0.5, 0.02, -0.14}, elbow, {0, 0.3, -1}, {}, 12},
      across{{-0.25, 0.08, -0.36}, elbow, {-0.3, 0.4, 1}, {}, 14};
  const ArmPose ahead{{0.15, 0.04, -0.47}, elbow, {-0.8, 0.3, -0.4}, {}, 12};
  return {"sweep", from_rest({{0.95, side, 8}, {1.35, ahead}, {1.75, across, -8}, {2.15, ahead}, {2.5, side, 8}}, 3.3)};
}

Act behind() {
  const ArmPose beside{{0.22, 0.42, 0.08}, {0.8, 0, 0.8}, {-0.4, 0, 1}, {}, 22};
  const ArmPose hidden{{-0.14, 0.3, 0.19}, {1, 0.2, 0.5}, {0, 0, 1}, {}, 28};
  return {"behind", from_rest({{0.7, beside}, {1.1, hidden}, {1.75, hidden}, {2.15, beside}}, 2.8)};
}

Act out() {
  const ArmPose raised{{0.2, -0.12, -0.3}, {1, 0.6, 0}, {0, 0, -1}, {}, 10},
      high{{0.09, -0.535, -0.06}, {1, 0, 0.3}, {0, 0, -1}, {}, 8};
  return {"out", from_rest({{0.85, raised}, {1.2, high}, {1.7, high}, {2.1, raised}}, 2.9)};
}

Act light() {
  const Vec3 elbow{0.6, 1, 0.2};
  const ArmPose wide{{0.3, 0.1, -0.34}, elbow, {0, -0.2, -1}, {0, -0.3, 0}, 12},
      middle{{0.0, 0.12, -0.4}, elbow, {-0.4, 0, -1}, {0, -0.3, 0}, 12};
  Act act{"light", from_rest({{0.9, wide}, {1.5, middle}, {2.1, wide}, {2.6, middle}}, 3.5)};
  act.lamp = 0.35;
  act.dim_s = 1.1;
  act.bright_s = 2.3;
  return act;
}

// Minimum jerk: the smoothest way from 0 to 1.
// Source  Flash, Hogan, "The coordination of arm movements", 1985
double eased(double x) { return x * x * x * (10 + x * (6 * x - 15)); }

Vec3 between(Vec3 a, Vec3 b, double x) { return (1 - x) * a + x * b; }

WayPoint on_way(const std::vector<WayPoint>& way, double t_s) {
  std::size_t next = 1;
  while (next + 1 < way.size() && way[next].t_s < t_s) ++next;
  const WayPoint &a = way[next - 1], &b = way[next];
  const double x = eased(std::clamp((t_s - a.t_s) / (b.t_s - a.t_s), 0.0, 1.0));
  const auto mid = [x](double p, double q) { return (1 - x) * p + x * q; };
  return {t_s,
          {between(a.arm.wrist_m, b.arm.wrist_m, x), between(a.arm.elbow, b.arm.elbow, x), between(a.arm.palm, b.arm.palm, x),
           between(a.arm.fingers, b.arm.fingers, x), mid(a.arm.curl_degrees, b.arm.curl_degrees)},
          mid(a.twist_degrees, b.twist_degrees)};
}

double lamp_at(const Act& act, double t_s) {
  constexpr double kFade_s = 0.3;
  if (act.dim_s >= act.bright_s) return 1;
  const double dark = smoothstep(act.dim_s, act.dim_s + kFade_s, t_s) - smoothstep(act.bright_s, act.bright_s + kFade_s, t_s);
  return 1 - (1 - act.lamp) * dark;
}

}  // namespace

std::vector<std::string> act_names() { return {"wave", "reach", "sweep", "behind", "out", "light"}; }

std::vector<Act> acts_of(std::string_view script) {
  const std::vector<Act> all = {wave(), reach(), sweep(), behind(), out(), light()};
  if (script == "tour") return all;
  for (const Act& act : all)
    if (act.name == script) return {act};
  return {};
}

double Script::length_s() const {
  double sum = 0;
  for (const Act& act : acts_) sum += act.length_s();
  return sum;
}

Script::Moment Script::at(double t_s) const {
  const double length = length_s();
  double in_act = t_s - length * floor_int(t_s / length);
  const Act* act = &acts_.front();
  for (const Act& a : acts_) {
    act = &a;
    if (in_act < a.length_s()) break;
    if (&a != &acts_.back()) in_act -= a.length_s();
  }
  const auto swing = [&](int which, double hz) { return sin_turns(hz * t_s + unit(hash(seed_, which))); };
  const WayPoint now = on_way(act->way, in_act);
  Moment out;
  out.act = act->name;
  out.lamp = lamp_at(*act, in_act);
  Pose& pose = out.pose;
  pose.sway_m = {0.006 * swing(1, 0.31) + 0.002 * swing(2, 0.83), 0.0015 * swing(3, 0.27), 0.006 * swing(4, 0.23)};
  pose.lean_degrees = 0.7 * swing(5, 0.29);
  // Positive about y turns z towards x: the right side, at -x, comes forward.
  pose.twist_degrees = 1.2 * swing(6, 0.19) - outwards(arm_) * now.twist_degrees;
  pose.look_degrees = 4 * swing(7, 0.21) + 1.5 * swing(8, 0.47);
  pose.nod_degrees = 5 + 2 * swing(9, 0.33);  // the cameras stand lower than the eyes
  for (int side = 0; side < 2; ++side) {
    ArmPose& arm = pose.arms[side];
    arm = side == arm_ ? now.arm : kHanging;
    constexpr double kTremor_m = 0.0012;
    arm.wrist_m = arm.wrist_m +
                  kTremor_m * Vec3{swing(10 + 3 * side, 7.1), swing(11 + 3 * side, 8.3), swing(12 + 3 * side, 6.4)} +
                  0.006 * Vec3{swing(20 + side, 0.37), 0, swing(22 + side, 0.43)};
  }
  return out;
}

}  // namespace duo::synthetic
