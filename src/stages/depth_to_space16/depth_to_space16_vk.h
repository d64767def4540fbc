#pragma once

#include "stages/depth_to_space16/depth_to_space16.h"
#include "vulkan/recorder.h"
#include "vulkan/tensor.h"

namespace duo::vk {

/// Channels as pixels on a device; the contract is in depth_to_space16.h.
class DepthToSpace16 {
 public:
  static Result<DepthToSpace16> make(const Device& device);
  void record(Recorder& recorder, const Tensors16& x, const Tensors16& y) const;

 private:
  Kernel kernel_;
};

}  // namespace duo::vk
