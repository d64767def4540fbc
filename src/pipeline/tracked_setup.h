// What the frames of a tracker are, beside what its user asks for.
#pragma once

#include <algorithm>
#include <cstdint>

#include "duoptic/engine.h"

namespace duo {

/// From one tracked frame to the next. Where frames are left out at will it stays below the second that trackers can bridge; a
/// source that is that slow by itself is theirs to refuse.
inline double tracked_frame_s(double frame_s, std::int64_t every) {
  constexpr double kMost_s = 0.99;
  return std::max(frame_s, std::min(frame_s * static_cast<double>(every), kMost_s));
}

inline void add_wants(const Wants& from, Wants& to) {
  to.color |= from.color;
  to.depth |= from.depth;
  to.confidence |= from.confidence;
  to.views |= from.views;
  to.disparity |= from.disparity;
  to.on_device |= from.on_device;
}

/// How deep joints lie under the skin was measured on disparities without the last fraction and with less penalty at gray
/// steps: trackers get the one and the other where the user names the parameter alone.
inline Setup setup_of_tracked(const Setup& wanted) {
  Setup out = wanted;
  const std::pair<std::string, double> measured[] = {{"refine", 0}, {"even", 0}};
  if (out.matcher == "sgm") out.parameters.insert(out.parameters.begin(), std::begin(measured), std::end(measured));
  return out;
}

}  // namespace duo
