// Times of a video's pictures that rise, whatever the file says.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "duoptic/frame.h"

namespace duo {

/// Mends times that go back: two recordings in one file, a clock that was set. A step back of less than two pictures is
/// jitter: that picture has the time of the one before. After a longer one times go on from the picture before, at the video's
/// rate, unless one of the next eight pictures goes on from before the step: then the times between were wrong.
class RisingTimes {
 public:
  /// The time of the next picture, which the file says to be `said_ns`; `frame_ns`: from picture to picture.
  TimeNs next(TimeNs said_ns, TimeNs frame_ns);
  /// The next picture follows none.
  void jump() { last_ns_.reset(); }
  /// What is to be said of it, in one line; empty: nothing.
  std::string warning(const std::string& file) const;

 private:
  std::optional<TimeNs> last_ns_;  // as given
  TimeNs later_ns_ = 0;            // than the file says
  TimeNs before_ns_ = 0;           // later_ns_ before the last step back
  int since_ = 0;                  // pictures after it
  std::int64_t pictures_ = 0, first_back_ = 0, back_ = 0;
};

}  // namespace duo
