// Recordings that observe frames on a device, made once for the slots of a setup.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "trackers/thesis/device_observer.h"
#include "trackers/thesis/observe_joints_vk.h"
#include "vulkan/frame_on_device.h"
#include "vulkan/timer.h"

namespace duo::vk {

class VulkanObserver final : public thesis::DeviceObserver {
 public:
  bool observe(DeviceMaps& frame, const Expectation& expected, Observation& seen) override;
  Result<const Frame*> maps(DeviceMaps& frame) override;

 private:
  /// The recordings of one setup.
  class Recordings {
   public:
    /// Errors  the device lacks memory, or the driver refuses a kernel
    static Result<std::unique_ptr<Recordings>> make(std::shared_ptr<const FrameMaps> maps);

    const FrameMaps* of() const { return maps_.get(); }
    /// Errors  those of Recorder::submit() and Device::wait(): nothing was seen
    Result<void> observe(int slot, const Expectation& expected, Observation& seen);
    Result<void> fetch(int slot);
    const Frame& fetched() const { return fetched_; }

   private:
    struct Slot {
      Timer timer;
      std::optional<Recorder> observe, fetch;
    };
    explicit Recordings(std::shared_ptr<const FrameMaps> maps) : maps_(std::move(maps)) {}
    Result<void> record(const FrameMaps::Slot& maps, Slot& slot);

    // In this order: recorders wait for their work before what it uses is destroyed.
    std::shared_ptr<const FrameMaps> maps_;
    std::unique_ptr<ObserveJoints> joints_;  // recordings hold its address
    FrameMaps::Slot down_;
    std::vector<Slot> slots_;
    std::optional<Recorder> points_up_;
    Frame fetched_;
  };

  /// Calls `with` with the recordings of the frame's setup. After an error nothing is kept of the device.
  Result<void> use(DeviceMaps& frame, const auto& with);

  std::unique_ptr<Recordings> recordings_;  // null before the first frame, and after an error
};

}  // namespace duo::vk
