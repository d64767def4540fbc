#pragma once

#include "stages/conv_first16/conv_first16.h"
#include "vulkan/recorder.h"
#include "vulkan/tensor.h"

namespace duo::vk {

/// The first convolution on a device; the contract is in conv_first16.h.
class ConvFirst16 {
 public:
  static Result<ConvFirst16> make(const Device& device);
  /// `constants` holds the packed layer from word `at` on.
  void record(Recorder& recorder, const duo::ConvFirst16& layer, const Buffer& constants, std::size_t at, const Tensors16& x,
              const Tensors16& y) const;

 private:
  Kernel kernel_;
};

}  // namespace duo::vk
