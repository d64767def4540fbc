// Runs that find nothing, or almost nothing.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "duoptic/engine.h"

namespace duo {

/// Whether frames of files have depth, and people where a tracker looks for them; and if not, why: pictures that are small,
/// dark or without texture. And whether much of the scene is nearer than what is searched, whose depth is wrong then.
///
/// Threads  one caller
class FoundWatch {
 public:
  FoundWatch() = default;  // looks at nothing
  /// `people`: a tracker looks for them.
  FoundWatch(const Setup& frames, const Rectified& rectified, bool people);

  void see(const Frame& frame, const Pair& pair, std::size_t people);
  /// No frame will come.
  void end() { counts_.ended = true; }
  /// Another source begins.
  void forget() { counts_ = {}; }
  /// In one line; empty: enough was found. `cause_told`: it was said that the rig does not fit.
  std::string warning(bool cause_told) const;

 private:
  std::string cause_of(const Pair& pair) const;
  std::optional<std::string> too_near(const Pair& pair) const;

  bool on_ = false, people_ = false;
  std::optional<Rig> rig_;
  int max_disparity_ = 0;
  double px_of_lens_ = 1;          // of the rectified pair, per pixel of the rig's left lens
  double disparity_by_depth_ = 0;  // px m; 0: there is no metric rig
  struct Counts {
    std::int64_t frames = 0, with_people = 0;
    std::int64_t whole = 0, little = 0;    // matched all over; and of these with little
    double known = 0;                      // share of pixels, summed over whole frames
    std::string cause = {};                // of the last frame with little that was looked into
    std::optional<std::string> near = {};  // what is said of a scene that is nearer than what is searched; none: not looked at
    std::uint64_t near_frame = 0;          // of which frame
    bool ended = false;
  };
  Counts counts_;
};

}  // namespace duo
