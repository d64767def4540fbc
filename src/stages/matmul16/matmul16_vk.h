#pragma once

#include "stages/matmul16/matmul16.h"
#include "vulkan/recorder.h"
#include "vulkan/tensor.h"

namespace duo::vk {

/// 1x1 convolutions on a device; the contract is in matmul16.h.
class Matmul16 {
 public:
  static Result<Matmul16> make(const Device& device);
  /// `constants` holds the packed layer from word `at` on.
  void record(Recorder& recorder, const duo::Matmul16& layer, const Buffer& constants, std::size_t at, const Tensors16& x,
              const Tensors16& y) const;

 private:
  Kernel kernel_;
};

}  // namespace duo::vk
