#pragma once

#include "stages/maxpool2x16/maxpool2x16.h"
#include "vulkan/recorder.h"
#include "vulkan/tensor.h"

namespace duo::vk {

/// The largest of each 2x2 pixels on a device; the contract is in maxpool2x16.h.
class Maxpool2x16 {
 public:
  static Result<Maxpool2x16> make(const Device& device);
  void record(Recorder& recorder, const Tensors16& x, const Tensors16& y) const;

 private:
  Kernel kernel_;
};

}  // namespace duo::vk
