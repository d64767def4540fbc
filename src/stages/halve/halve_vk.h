#pragma once

#include "stages/halve/halve.h"
#include "vulkan/recorder.h"

namespace duo::vk {

/// One step of the pyramid on a device; the contract is in halve.h.
class Halve {
 public:
  static Result<Halve> make(const Device& device);
  /// `size` is that of src; dst is half_of() it.
  void record(Recorder& recorder, BufferView<std::uint8_t> src, BufferView<std::uint8_t> dst, Size size) const;
  void record_inside(Recorder& recorder, BufferView<std::uint8_t> src, BufferView<std::uint8_t> dst, Size size) const;

 private:
  void record_with(Recorder& recorder, BufferView<std::uint8_t> src, BufferView<std::uint8_t> dst, Size size, bool all) const;

  Kernel kernel_;
};

}  // namespace duo::vk
