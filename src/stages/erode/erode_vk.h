#pragma once

#include "stages/erode/erode.h"
#include "vulkan/recorder.h"

namespace duo::vk {

/// Erosion on a device; the contract is in erode.h.
class Erode {
 public:
  static Result<Erode> make(const Device& device);
  void record(Recorder& recorder, BufferView<std::uint8_t> src, Neighbours neighbours, BufferView<std::uint8_t> dst,
              Size size) const;

 private:
  Kernel kernel_;
};

}  // namespace duo::vk
