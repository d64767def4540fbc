// Timer: time of each part of a recording, by the device's own clock.
#pragma once

#include <span>
#include <vector>

#include "vulkan/recorder.h"

namespace duo::vk {

/// Given to Recorder::begin(); read() once the work is finished.
class Timer {
 public:
  struct Time {
    const char* stage;
    double ns;  // 0 on a device without a clock
  };
  /// Errors  out of memory
  static Result<Timer> make(const Device& device, int stages);

  /// The parts in their order. Valid until the next read(), which allocates nothing.
  ///
  /// Errors  the work is not finished
  Result<std::span<const Time>> read();

 private:
  friend class Recorder;
  void start(Recorder& recorder);
  /// At most as many as given to make().
  void stage(Recorder& recorder, const char* name);
  void stamp(Recorder& recorder, std::size_t index);

  const Device* device_ = nullptr;
  std::size_t capacity_ = 0;
  std::vector<Time> times_;
  std::vector<std::uint64_t> ticks_;
  OwnedQueries queries_;
};

}  // namespace duo::vk
