#pragma once

#include "stages/resize2x16/resize2x16.h"
#include "vulkan/recorder.h"
#include "vulkan/tensor.h"

namespace duo::vk {

/// Twice the size, interpolated on a device; the contract is in resize2x16.h.
class Resize2x16 {
 public:
  static Result<Resize2x16> make(const Device& device);
  void record(Recorder& recorder, const Tensors16& x, const Tensors16& y) const;

 private:
  Kernel kernel_;
};

}  // namespace duo::vk
