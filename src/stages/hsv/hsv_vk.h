#pragma once

#include "stages/hsv/hsv.h"
#include "vulkan/recorder.h"

namespace duo::vk {

/// Colour to hue, saturation, value on a device; the contract is in hsv.h.
class Hsv {
 public:
  /// HsvPlanes on the device.
  struct Planes {
    BufferView<std::uint8_t> hue, saturation, value;
  };
  static Result<Hsv> make(const Device& device);
  void record(Recorder& recorder, BufferView<Rgb8> src, const Planes& dst, Size size) const;

 private:
  Kernel kernel_;
};

}  // namespace duo::vk
