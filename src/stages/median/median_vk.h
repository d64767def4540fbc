#pragma once

#include "stages/median/median.h"
#include "vulkan/recorder.h"

namespace duo::vk {

/// Median 3x3 on a device; the contract is in median.h.
class Median {
 public:
  static Result<Median> make(const Device& device);
  void record(Recorder& recorder, BufferView<std::uint8_t> src, BufferView<std::uint8_t> dst, Size size) const;
  void record(Recorder& recorder, BufferView<std::uint16_t> src, BufferView<std::uint16_t> dst, Size size) const;

 private:
  Kernel u8_, u16_;
};

}  // namespace duo::vk
