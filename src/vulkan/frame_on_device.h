// A frame whose maps stay on the device that made them, for whoever runs kernels of their own on it.
#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "duoptic/frame.h"
#include "vulkan/buffer.h"
#include "vulkan/device.h"

namespace duo::vk {

/// Where the maps of the frames of one setup lie, a slot a frame. A recording holds the addresses of its buffers: whoever
/// records shares their ownership.
///
/// Shape   all H x W, rows without gaps
struct FrameMaps {
  struct Slot {
    Buffer left;   // u8
    Buffer color;  // Rgb8
    Buffer d_q4;   // u16
  };
  std::shared_ptr<Device> device;  // first member: destroyed last
  Size size;
  bool time_stages = false;
  std::vector<Slot> slots;
};

/// What Frame::on_device points to.
class FrameOnDevice : public DeviceMaps {
 public:
  using Work = std::function<Result<void>(const std::shared_ptr<const FrameMaps>& maps, int slot)>;
  /// Calls `work` while the engine leaves the device and the slot alone. After an error of `work` the engine gives the device
  /// up and goes on with the CPU.
  ///
  /// Errors   the device or the engine is gone, or newer frames have taken the place of this one, which only the two last
  ///          collected ones are safe from: nothing was called; those of `work`
  /// Threads  one at a time, which need not be the engine's caller
  virtual Result<void> use(const Work& work) = 0;
};

}  // namespace duo::vk
