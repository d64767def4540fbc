#pragma once

#include "stages/histogram/histogram.h"
#include "vulkan/area.h"
#include "vulkan/recorder.h"

namespace duo::vk {

/// Colours of areas on a device; the contract is in histogram.h.
class Histogram {
 public:
  /// duo::ColorCount on the device, for `count` areas at once: `areas` holds a DeviceArea each. Without marks all pixels count.
  struct Input {
    const Buffer* areas = nullptr;
    int count = 0;
    BufferView<std::uint8_t> hue, saturation, value;
    BufferView<std::uint8_t> marks = {};
    std::uint8_t min_value = 0;
  };
  static Result<Histogram> make(const Device& device);
  /// results: ColorHistogram[count] and nothing else
  void record(Recorder& recorder, const Input& in, const Buffer& results, Size size) const;

 private:
  Kernel kernel_;
};

}  // namespace duo::vk
