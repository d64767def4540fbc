#include "sources/synthetic/script.h"

#include <algorithm>
#include <cmath>
#include <tuple>

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

// The hand is held up and turns a little; thumb and index finger meet and part.
Act pinch() {
  const auto held = [](double pinch, double aside) {
    return ArmPose{{0.16 + aside, 0.02, -0.42}, {0.6, 1, 0}, {-0.35 + 2 * aside, 0, -1}, {0, -1.1, 0}, 14, pinch};
  };
  return {"pinch", from_rest({{0.9, held(0, 0)},
                              {1.15, held(1, 0.02)},
                              {1.4, held(1, 0.04)},
                              {1.7, held(0, 0.06)},
                              {2.0, held(1, 0.02)},
                              {2.2, held(0.5, -0.02)},
                              {2.5, held(0, -0.04)}},
                             3.3)};
}

// --- Of the whole body ---------------------------------------------------------------------------------------------------

Act of_body(std::string_view name, std::vector<WayPoint> between, std::vector<Stance> stances) {
  const double length_s = stances.back().t_s;
  return {.name = name, .way = from_rest(std::move(between), length_s), .stances = std::move(stances)};
}

// Once around, an arm before the chest at first.
Act turn_around() {
  const ArmPose chest{{-0.12, 0.2, -0.3}, {1, 0.6, 0.2}, {0, 0, 1}, {}, 16};
  return of_body("turn", {{0.8, chest}, {1.7, chest}, {2.5, kHanging}}, {{0.0}, {0.4}, {3.0, {}, 360}, {3.6, {}, 360}});
}

std::vector<Stance> to_and_fro() {
  constexpr double kHalf_m = 0.75;
  const Vec3 right{-kHalf_m, 0, 0}, left{kHalf_m, 0, 0};
  return {{0, right}, {0.2, right}, {0.8, right, -90}, {2.4, left, -90}, {3.2, left, 90}, {4.8, right, 90}, {5.4, right}};
}

Act walk_across() { return of_body("walk", {{2, kHanging}}, to_and_fro()); }
Act cross_ways() { return of_body("cross", {{2, kHanging}}, to_and_fro()); }

// On to a chair, one leg over the other, and up again.
Act sit_down() {
  const ArmPose lap{{-0.03, 0.42, -0.24}, {1, 0.3, 0.3}, {0, 1, 0.2}, {}, 20};
  const LegPose feet;
  const LegPose over{{-0.17, -0.36, -0.3}, {0.1, -1, -0.5}, 35};
  const Vec3 seat{0, 0.32, 0.34};
  return of_body("sit", {{1.4, lap}, {4.0, lap}},
                 {{0},
                  {0.3},
                  {0.8, {}, 0, {0, 0.14, 0.2}, 35},
                  {1.3, {}, 0, seat, 6},
                  {1.7, {}, 0, seat, 6},
                  {2.4, {}, 0, seat, -2, {over, feet}},
                  {3.2, {}, 0, seat, -2, {over, feet}},
                  {3.9, {}, 0, seat, 6},
                  {4.4, {}, 0, {0, 0.14, 0.2}, 35},
                  {5.0}});
}

// Minimum jerk: the smoothest way from 0 to 1.
// Source  Flash, Hogan, "The coordination of arm movements", 1985
double eased(double x) { return x * x * x * (10 + x * (6 * x - 15)); }

Vec3 between(Vec3 a, Vec3 b, double x) { return (1 - x) * a + x * b; }

// Of points in the order of time, the two around a moment, and how far it is from the first to the second.
template <class Point>
std::tuple<const Point&, const Point&, double> around(const std::vector<Point>& points, double t_s) {
  std::size_t next = 1;
  while (next + 1 < points.size() && points[next].t_s < t_s) ++next;
  const Point &a = points[next - 1], &b = points[next];
  return {a, b, std::clamp((t_s - a.t_s) / (b.t_s - a.t_s), 0.0, 1.0)};
}

WayPoint on_way(const std::vector<WayPoint>& way, double t_s) {
  const auto [a, b, done] = around(way, t_s);
  const double x = eased(done);
  const auto mid = [x](double p, double q) { return (1 - x) * p + x * q; };
  return {
      t_s,
      {between(a.arm.wrist_m, b.arm.wrist_m, x), between(a.arm.elbow, b.arm.elbow, x), between(a.arm.palm, b.arm.palm, x),
       between(a.arm.fingers, b.arm.fingers, x), mid(a.arm.curl_degrees, b.arm.curl_degrees), mid(a.arm.pinch, b.arm.pinch)},
      mid(a.twist_degrees, b.twist_degrees)};
}

Stance stance_at(const std::vector<Stance>& stances, double t_s) {
  const auto [a, b, done] = around(stances, t_s);
  const double x = eased(done);
  const auto mid = [x](double p, double q) { return (1 - x) * p + x * q; };
  Stance out{t_s, between(a.at_m, b.at_m, x), mid(a.facing_degrees, b.facing_degrees), between(a.hips_m, b.hips_m, x),
             mid(a.bow_degrees, b.bow_degrees)};
  for (std::size_t leg = 0; leg < 2; ++leg)
    out.legs[leg] = {between(a.legs[leg].ankle_m, b.legs[leg].ankle_m, x), between(a.legs[leg].knee, b.legs[leg].knee, x),
                     mid(a.legs[leg].toes_degrees, b.legs[leg].toes_degrees)};
  return out;
}

/// Steps of a person who walks or turns: where in a pair of them it is, and how far legs and arms swing and feet are lifted.
struct Gait {
  double turns = 0, swing = 0, lift = 0;
};

Gait gait_at(const std::vector<Stance>& stances, double t_s) {
  constexpr double kStep_m = 0.52, kStep_degrees = 60, kFast_m_s = 0.8, kOften_per_s = 1.2;
  Gait out;
  double steps = 0;
  for (std::size_t i = 1; i < stances.size() && stances[i - 1].t_s < t_s; ++i) {
    const Stance &a = stances[i - 1], &b = stances[i];
    const double length_s = b.t_s - a.t_s, x = std::min((t_s - a.t_s) / length_s, 1.0);
    const double way_m = norm(b.at_m - a.at_m);
    const double all = way_m / kStep_m + std::abs(b.facing_degrees - a.facing_degrees) / kStep_degrees;
    const double per_s = 30 * x * x * (1 - x) * (1 - x) / length_s;  // of the way, by the slope of eased()
    steps += all * eased(x);
    out.swing = std::min(way_m * per_s / kFast_m_s, 1.0);
    out.lift = std::min(all * per_s / kOften_per_s, 1.0);
  }
  out.turns = steps / 2;
  return out;
}

void walk_by(const Gait& gait, Pose& pose) {
  constexpr double kLeg_m = 0.26, kLift_m = 0.09, kSink_m = 0.035, kArm_m = 0.16, kToes_degrees = 20;
  pose.hips_m.y += kSink_m * gait.swing;
  for (int side = 0; side < 2; ++side) {
    const double phase = gait.turns + (side == kRightSide ? 0 : 0.5), ahead = gait.swing * sin_turns(phase);
    LegPose& leg = pose.legs[side];
    leg.ankle_m.z -= kLeg_m * ahead;
    leg.ankle_m.y -= kLift_m * gait.lift * std::max(cos_turns(phase), 0.0);
    leg.toes_degrees -= kToes_degrees * ahead;
    pose.arms[side].wrist_m.z += kArm_m * ahead;
  }
}

double lamp_at(const Act& act, double t_s) {
  constexpr double kFade_s = 0.3;
  if (act.dim_s >= act.bright_s) return 1;
  const double dark = smoothstep(act.dim_s, act.dim_s + kFade_s, t_s) - smoothstep(act.bright_s, act.bright_s + kFade_s, t_s);
  return 1 - (1 - act.lamp) * dark;
}

}  // namespace

std::vector<std::string> act_names() {
  return {"wave", "reach", "sweep", "behind", "out", "light", "pinch", "turn", "walk", "sit", "cross"};
}

std::vector<Act> acts_of(std::string_view script) {
  const std::vector<Act> tour = {wave(), reach(), sweep(), behind(), out(), light()};
  if (script == "tour") return tour;
  std::vector<Act> all = tour;
  for (const auto& act : {pinch, turn_around, walk_across, sit_down, cross_ways}) all.push_back(act());
  for (const Act& act : all)
    if (act.name == script) return {act};
  return {};
}

std::vector<Act> second_acts_of(std::string_view script) {
  constexpr double kNearer_m = 0.55;
  if (script != "cross") return {};
  Act act = cross_ways();
  for (Stance& stance : act.stances) {
    stance.at_m = {-stance.at_m.x, 0, -kNearer_m};
    stance.facing_degrees = -stance.facing_degrees;
  }
  return {act};
}

bool is_of_whole_body(std::string_view script) {
  return std::ranges::any_of(acts_of(script), [](const Act& act) { return !act.stances.empty(); });
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
  pose.hips_m = {0.006 * swing(1, 0.31) + 0.002 * swing(2, 0.83), 0.0015 * swing(3, 0.27), 0.006 * swing(4, 0.23)};
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
  if (act->stances.empty()) return out;
  const Stance stance = stance_at(act->stances, in_act);
  pose.hips_m = pose.hips_m + stance.hips_m;
  pose.bow_degrees = stance.bow_degrees;
  for (int side = 0; side < 2; ++side) pose.legs[side] = stance.legs[side == arm_ ? 0 : 1];
  walk_by(gait_at(act->stances, in_act), pose);
  out.stage_from_person = {about_y(stance.facing_degrees), stance.at_m};
  return out;
}

}  // namespace duo::synthetic
