#include "duoptic/skew_watch.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "stages/align_time/align_time.h"

namespace duo {

double skew_depth_error_m(double z_m, double speed_m_s, double skew_s, double baseline_m) {
  return z_m * speed_m_s * skew_s / baseline_m;
}

std::optional<std::string> SkewWatch::see(const TrackedFrame& frame) {
  constexpr double kLeastError_m = 0.03, kQuiet_s = 10, kForget_s = 60;
  constexpr double kSmooth_s = 0.15;  // from frame to frame the speed would mostly be noise
  const double skew_s = static_cast<double>(frame.frame->skew_ns) * 1e-9;
  std::optional<std::string> warning;
  double worst_m = kLeastError_m;
  std::erase_if(before_, [&](const auto& joint) { return frame.t_s - joint.second.t_s > kForget_s; });
  for (const Person& person : frame.people)
    for (std::size_t j = 0; j < person.count(); ++j) {
      const Joint& joint = person.joints[j];
      const JointId id = person.skeleton->joints[j].id;
      Seen& before = before_[{person.id, id}];
      Seen now{joint.p_in_rig_m.x, frame.t_s, 0, joint.state == JointState::kSeen};
      const double dt_s = now.t_s - before.t_s;
      if (now.valid && before.valid && dt_s > 0) {
        const double step_m_s = (now.x_m - before.x_m) / dt_s;
        now.speed_m_s = before.speed_m_s + std::min(1.0, dt_s / kSmooth_s) * (step_m_s - before.speed_m_s);
        const double error_m =
            ref::AlignTime::kErrorLeft * std::abs(skew_depth_error_m(joint.p_in_rig_m.z, now.speed_m_s, skew_s, baseline_m_));
        if (error_m > worst_m && error_m > joint.sigma_m()) {
          worst_m = error_m;
          warning = fmt::format(
              "the right picture was taken {:.1f} ms after the left one, and the {} moves sideways at {:.1f} m/s: its depth "
              "may be off by some {:.0f} mm; move slower, or start the cameras again until they run closer together",
              skew_s * 1e3, part_of(id), std::abs(now.speed_m_s), error_m * 1e3);
        }
      }
      before = now;
    }
  if (!warning || (warned_s_ && frame.t_s - *warned_s_ < kQuiet_s)) return std::nullopt;
  warned_s_ = frame.t_s;
  return warning;
}

}  // namespace duo
