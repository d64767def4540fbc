#pragma once

#include "stages/fill/fill.h"
#include "vulkan/recorder.h"

namespace duo::vk {

/// Marks what was measured on a device; the contract is in fill.h. Filling itself is left to the CPU.
class Fill {
 public:
  static Result<Fill> make(const Device& device);
  /// mark_measured().
  void record_measured(Recorder& recorder, BufferView<std::uint16_t> d_q4, BufferView<std::uint8_t> origin, Size size) const;

 private:
  Kernel kernel_;
};

}  // namespace duo::vk
