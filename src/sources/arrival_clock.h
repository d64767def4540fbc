// When the pictures of a network camera were taken, from when they arrived.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "sources/camera/clock_model.h"

namespace duo {

/// A network camera sends no times that can be trusted, and none of its rate: both come from arrivals. The rate is the median
/// of the first steps from picture to picture; then a line smooths what the network adds (clock_model.h). A picture that is
/// lost on the way leaves a gap of a whole step, one that is late does not: it is the next one that comes sooner.
///
/// Threads  one caller
class ArrivalClock {
 public:
  /// `frame_s`: from picture to picture where that is known; 0: it is measured.
  explicit ArrivalClock(double frame_s);

  /// When the picture was taken that arrived at `arrived_ns`, but for what all of them need on their way.
  TimeNs capture_ns(TimeNs arrived_ns);
  /// From picture to picture, in seconds; 0 where too few have arrived.
  double frame_s() const { return frame_ns_ * 1e-9; }

 private:
  double frame_ns_;
  std::vector<TimeNs> steps_ns_;  // until the rate is known
  std::optional<ClockModel> line_;
  std::int64_t number_ = 0;
  TimeNs last_arrival_ns_ = 0, last_ns_ = 0;
  bool any_ = false;
};

}  // namespace duo
