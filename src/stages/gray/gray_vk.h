#pragma once

#include "stages/gray/gray.h"
#include "vulkan/recorder.h"

namespace duo::vk {

/// Colour to gray on a device; the contract is in gray.h.
class Gray {
 public:
  static Result<Gray> make(const Device& device);
  /// `src` as sources deliver it: three bytes a pixel, its plane in pixels.
  void record(Recorder& recorder, BufferView<Rgb8> src, BufferView<std::uint8_t> dst, Size size) const;

 private:
  Kernel kernel_;
};

}  // namespace duo::vk
