#pragma once

#include "stages/bilateral/bilateral.h"
#include "vulkan/recorder.h"

namespace duo::vk {

/// The bilateral filter on a device; the contract is in bilateral.h.
class Bilateral {
 public:
  static Result<Bilateral> make(const Device& device);
  /// `noise_q4`: one word, from which the range follows.
  void record(Recorder& recorder, BufferView<std::uint8_t> src, const Buffer& noise_q4, BufferView<std::uint8_t> dst,
              Size size) const;

 private:
  Kernel kernel_;
};

}  // namespace duo::vk
