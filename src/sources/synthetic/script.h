// What a person does: poses and light over time.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "sources/synthetic/bones.h"

namespace duo::synthetic {

struct WayPoint {
  double t_s = 0;
  ArmPose arm;
  double twist_degrees = 0;  // of the torso, towards the arm's side
};

/// Where the person stands and how, at a moment of an act. On the way to the next one it makes the steps that it needs.
///
/// Units  at_m: on the floor, from where the person stands at first; facing_degrees: turned from the cameras, to its own right;
///        hips_m and legs as in Pose; legs: of the arm's side, then the other
struct Stance {
  double t_s = 0;
  Vec3 at_m = {};
  double facing_degrees = 0;
  Vec3 hips_m = {};
  double bow_degrees = 0;
  std::array<LegPose, 2> legs = {};
};

/// One thing to do, from rest to rest. The lamp is dimmed to `lamp` between `dim_s` and `bright_s`, when these differ. Without
/// stances the person stays where it is.
struct Act {
  std::string_view name;
  std::vector<WayPoint> way;
  double lamp = 1, dim_s = 0, bright_s = 0;
  std::vector<Stance> stances = {};
  double length_s() const { return way.back().t_s; }
};

/// Acts one after the other; after the last the first comes again.
class Script {
 public:
  struct Moment {
    Pose pose;
    Rigid3 stage_from_person;  // where the person stands
    double lamp = 1;           // power of the ceiling lamp
    std::string_view act;
  };

  /// `seed` gives sway and tremor their phases. The other arm hangs.
  Script(std::vector<Act> acts, int arm, std::uint32_t seed) : acts_(std::move(acts)), arm_(arm), seed_(seed) {}

  double length_s() const;
  Moment at(double t_s) const;

 private:
  std::vector<Act> acts_;
  int arm_;
  std::uint32_t seed_;
};

/// wave, reach, sweep, behind, out, light of an arm, tour: all of these; pinch of its fingers; turn, walk, sit, cross of the
/// whole body. Empty when there is no such script.
std::vector<Act> acts_of(std::string_view script);
/// What a second person does meanwhile: in cross it comes the other way, nearer to the cameras. Empty: there is none.
std::vector<Act> second_acts_of(std::string_view script);
/// Whether the whole body moves, so that the cameras should see it down to the feet.
bool is_of_whole_body(std::string_view script);
std::vector<std::string> act_names();

}  // namespace duo::synthetic
