#include "sources/arrival_clock.h"

#include <algorithm>
#include <cmath>

#include "duoptic/statistics.h"

namespace duo {

ArrivalClock::ArrivalClock(double frame_s) : frame_ns_(frame_s * 1e9) {
  if (frame_s > 0) line_.emplace(frame_s);
}

TimeNs ArrivalClock::capture_ns(TimeNs arrived_ns) {
  constexpr std::size_t kSteps = 5;
  constexpr double kLate = 0.8;  // steps: a picture that much later than the one before it lets expect is none that was lost
  if (any_ && !line_) {
    steps_ns_.push_back(arrived_ns - last_arrival_ns_);
    if (steps_ns_.size() == kSteps) {
      frame_ns_ = std::max(static_cast<double>(median(steps_ns_)), 1e6);
      line_.emplace(frame_ns_ * 1e-9);
    }
  }
  last_arrival_ns_ = arrived_ns;
  if (!line_) {
    any_ = true;
    return last_ns_ = arrived_ns;
  }
  const double steps = any_ ? static_cast<double>(arrived_ns - last_ns_) / frame_ns_ : 1;
  any_ = true;
  number_ += std::max<std::int64_t>(1, static_cast<std::int64_t>(std::floor(steps + 1 - kLate)));
  return last_ns_ = line_->capture_ns(number_, arrived_ns);
}

}  // namespace duo
