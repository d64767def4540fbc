// What it costs that two cameras do not take their pictures at the same moment.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <utility>

#include "duoptic/sink.h"

namespace [[gnu::visibility("default")]] duo {

/// How far off the depth of a moving point is when nothing is done about it: between the two pictures it moves v dt along the
/// baseline, which is taken for disparity: dz = z v dt / b.
///
/// Units   metres, seconds; v along the baseline; signs are kept
double skew_depth_error_m(double z_m, double speed_m_s, double skew_s, double baseline_m);

/// Looks at the joints of live frames, one after the other, for movement that the skew turns into wrong depth.
class SkewWatch {
 public:
  explicit SkewWatch(double baseline_m) : baseline_m_(baseline_m) {}

  /// A warning when a seen joint's depth may still be off by more than 30 mm and by more than its sigma; then none for ten
  /// seconds.
  std::optional<std::string> see(const TrackedFrame& frame);

 private:
  struct Seen {
    double x_m = 0, t_s = 0, speed_m_s = 0;
    bool valid = false;
  };
  double baseline_m_;
  std::map<std::pair<std::uint32_t, JointId>, Seen> before_;  // of each person's joints
  std::optional<double> warned_s_;
};

}  // namespace duo
