#pragma once

#include "stages/fill/fill.h"
#include "vulkan/recorder.h"

namespace duo::vk {

/// Filling on a device; the contract is in fill.h.
class Fill {
 public:
  static Result<Fill> make(const Device& device);
  /// mark_measured().
  void record_measured(Recorder& recorder, BufferView<std::uint16_t> d_q4, BufferView<std::uint8_t> origin, Size size) const;
  /// mark_measured() and fill() in one pass over the rows.
  void record(Recorder& recorder, BufferView<std::uint16_t> d_q4, BufferView<std::uint8_t> origin, Size size) const;

 private:
  void record_with(Recorder& recorder, BufferView<std::uint16_t> d_q4, BufferView<std::uint8_t> origin, Size size,
                   bool fills) const;

  Kernel kernel_;
};

}  // namespace duo::vk
