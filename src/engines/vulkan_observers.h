// What trackers see of frames that stay on the device.
#pragma once

#include <optional>
#include <vector>

#include "trackers/arm/thesis_vk.h"
#include "vulkan/timer.h"

namespace duo::vk {

/// The maps of each slot's frame that are looked at, and the recordings that look.
///
/// Errors   those of Recorder::submit() and Device::wait(): nothing was seen
/// Threads  one, while another submits and collects other slots
class Observers {
 public:
  struct Maps {
    Buffer left, color, d_q4;
  };
  /// Errors  the device lacks memory, or the driver refuses a kernel
  static Result<Observers> make(Device& device, Size size, int slots, bool time_stages);

  /// Where a slot's frame goes.
  const Maps& maps(int slot) const { return slots_[static_cast<std::size_t>(slot)].maps; }
  Result<void> observe(int slot, const Expectation& expected, Observation& seen);
  /// left, color and disparity.d_q4 come down into the frame's memory.
  Result<void> fetch(int slot, Frame& frame);

 private:
  struct Slot {
    Maps maps;
    Timer timer;
    std::optional<Recorder> observe, fetch;  // after what their work uses: they wait for it
  };

  explicit Observers(Device& device) : device_(&device) {}
  Result<void> make_slot(Slot& slot, Size size);
  Result<void> record(Slot& slot, Size size);

  Device* device_;
  bool time_stages_ = false;
  std::unique_ptr<ObserveJoints> joints_;  // recordings hold its address
  std::optional<Recorder> points_up_;
  Maps down_;
  std::vector<Slot> slots_;
};

}  // namespace duo::vk
