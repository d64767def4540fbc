#pragma once

#include "stages/sum_pixels16/sum_pixels16.h"
#include "vulkan/recorder.h"
#include "vulkan/tensor.h"

namespace duo::vk {

/// The sum of each channel on a device; the contract is in sum_pixels16.h.
class SumPixels16 {
 public:
  static Result<SumPixels16> make(const Device& device);
  void record(Recorder& recorder, const Tensors16& x, int shift, const Tensors16& y) const;

 private:
  Kernel kernel_;
};

}  // namespace duo::vk
