#pragma once

#include "stages/weighted_median/weighted_median.h"
#include "vulkan/recorder.h"

namespace duo::vk {

/// Weighted median on a device; the contract is in weighted_median.h.
class WeightedMedian {
 public:
  /// duo::WeightedMedian on the device.
  struct Input {
    BufferView<std::uint16_t> d_q4 = {};
    BufferView<std::uint8_t> guide = {};
  };
  static Result<WeightedMedian> make(const Device& device);
  void record(Recorder& recorder, const Input& in, BufferView<std::uint16_t> dst, Size size) const;

 private:
  Kernel kernel_;
};

}  // namespace duo::vk
