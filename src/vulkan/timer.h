// Timer: how long the parts of a recording take on the device's own clock.
#pragma once

#include <span>
#include <vector>

#include "vulkan/recorder.h"

namespace duo::vk {

/// Used like StageTimer: start() after Recorder::begin(), stage() after each part, read() once the work is finished.
class Timer {
 public:
  struct Time {
    const char* stage;
    double ns;  // 0 on a device without a clock
  };
  /// Errors  out of memory
  static Result<Timer> make(const Device& device, int stages);

  void start(Recorder& recorder);
  /// Ends the part that was recorded since the last call; at most as many as given to make().
  /// `name` lives as long as the timer.
  void stage(Recorder& recorder, const char* name);
  /// Valid until the next read(), which allocates nothing.
  ///
  /// Errors  the work is not finished
  Result<std::span<const Time>> read();

 private:
  void stamp(Recorder& recorder, std::size_t index);

  const Device* device_ = nullptr;
  std::size_t capacity_ = 0;
  std::vector<Time> times_;
  std::vector<std::uint64_t> ticks_;
  OwnedQueries queries_;
};

}  // namespace duo::vk
