#pragma once

#include "stages/gaussian/gaussian.h"
#include "vulkan/recorder.h"

namespace duo::vk {

/// Gaussian 5x5 on a device; the contract is in gaussian.h.
class Gaussian {
 public:
  static Result<Gaussian> make(const Device& device);
  void record(Recorder& recorder, BufferView<std::uint8_t> src, BufferView<std::uint8_t> dst, Size size) const;

 private:
  Kernel kernel_;
};

}  // namespace duo::vk
