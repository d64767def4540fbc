#pragma once

#include "stages/add16/add16.h"
#include "vulkan/recorder.h"
#include "vulkan/tensor.h"

namespace duo::vk {

/// Sums of two results on a device; the contract is in add16.h.
class Add16 {
 public:
  static Result<Add16> make(const Device& device);
  void record(Recorder& recorder, const duo::Add16& layer, const Tensors16& a, const Tensors16& b, const Tensors16& y) const;

 private:
  Kernel kernel_;
};

}  // namespace duo::vk
