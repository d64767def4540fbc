#include "sources/rising_times.h"

#include <fmt/format.h>

#include <algorithm>

namespace duo {

TimeNs RisingTimes::next(TimeNs said_ns, TimeNs frame_ns) {
  constexpr int kJitter = 2, kFew = 8;  // pictures
  if (last_ns_ && later_ns_ != before_ns_ && since_++ < kFew) {
    const TimeNs from_before_ns = said_ns + before_ns_;
    if (from_before_ns >= *last_ns_ && from_before_ns <= *last_ns_ + kFew * frame_ns) later_ns_ = before_ns_;
  }
  TimeNs t_ns = said_ns + later_ns_;
  if (last_ns_ && t_ns < *last_ns_) {
    if (back_++ == 0) first_back_ = pictures_;
    if (*last_ns_ - t_ns >= kJitter * frame_ns) {
      before_ns_ = later_ns_;
      since_ = 0;
      later_ns_ += *last_ns_ + frame_ns - t_ns;
    }
    t_ns = std::max(*last_ns_, said_ns + later_ns_);
  }
  ++pictures_;
  last_ns_ = t_ns;
  return t_ns;
}

std::string RisingTimes::warning(const std::string& file) const {
  if (back_ == 0) return {};
  return fmt::format(
      "the times of {} go back{} at picture {}: they are taken to go on from the picture before; if that is where two "
      "recordings were joined, give each by itself",
      file, back_ == 1 ? "" : fmt::format(" {} times, first", back_), first_back_);
}

}  // namespace duo
