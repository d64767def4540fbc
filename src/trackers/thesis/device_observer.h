// What the thesis tracker observes in frames that stay on a device.
#pragma once

#include <memory>

#include "trackers/thesis/observation.h"

namespace duo::thesis {

/// Takes memory and compiles kernels at the first frame of a setup.
///
/// Threads  one
class DeviceObserver {
 public:
  virtual ~DeviceObserver() = default;
  /// False when the device fails: nothing is seen of this frame, and the engine goes on without the device.
  virtual bool observe(DeviceMaps& frame, const Expectation& expected, Observation& seen) = 0;
  /// left, color and disparity.d_q4 of the frame, for clicks; valid until the next call.
  ///
  /// Errors  device lost, or without memory for it
  virtual Result<const Frame*> maps(DeviceMaps& frame) = 0;
};

/// Null in a build without Vulkan, whose frames have no maps on a device.
std::unique_ptr<DeviceObserver> make_device_observer();

}  // namespace duo::thesis
