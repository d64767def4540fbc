// What happens from frame to frame, by time: the same at any number of frames per second.
#pragma once

#include <algorithm>
#include <cmath>

namespace duo::body {

/// The tracker's unit of time, whatever the frames' rate is.
inline constexpr double kTick_s = 1.0 / 30;
/// To a 64th, and no less: files keep times in whole nanoseconds, and at 30 frames a second a frame is one tick.
inline double ticks_in(double seconds) { return std::max(1.0, std::round(64 * seconds / kTick_s)) / 64; }

// Of products alone, as std::pow() need not give the same bits on every processor; a fraction of a tick has its part of that
// tick's loss or gain.

/// What is left of 1 after some ticks of which each leaves a share.
constexpr double left_after(double ticks, double share) {
  double left = 1;
  for (; ticks >= 1; --ticks) left *= share;
  return left * (1 - ticks * (1 - share));
}

/// The weight of what is new after some ticks, where after each one it is `gain`.
constexpr double gain_over(double ticks, double gain) {
  double gained = 0;
  for (; ticks >= 1; --ticks) gained += gain * (1 - gained);
  return gained + ticks * gain * (1 - gained);
}

}  // namespace duo::body
