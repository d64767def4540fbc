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

/// One thing to do, from rest to rest. The lamp is dimmed to `lamp` between `dim_s` and `bright_s`, when these differ.
struct Act {
  std::string_view name;
  std::vector<WayPoint> way;
  double lamp = 1, dim_s = 0, bright_s = 0;
  double length_s() const { return way.back().t_s; }
};

/// Acts one after the other; after the last the first comes again.
class Script {
 public:
  struct Moment {
    Pose pose;
    double lamp = 1;  // power of the ceiling lamp
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

/// wave, reach, sweep, behind, out, light, or tour: all of them. Empty when there is no such script.
std::vector<Act> acts_of(std::string_view script);
std::vector<std::string> act_names();

}  // namespace duo::synthetic
