#pragma once

#include "stages/sample_depth/sample_depth.h"
#include "vulkan/area.h"
#include "vulkan/recorder.h"

namespace duo::vk {

/// Depths of areas on a device; the contract is in sample_depth.h.
class SampleDepth {
 public:
  /// `count` areas at once: `areas` holds a DeviceArea each. Without marks all pixels count.
  struct Input {
    const Buffer* areas = nullptr;
    int count = 0;
    BufferView<std::uint16_t> d_q4;
    BufferView<std::uint8_t> marks = {};
  };
  /// Histograms of up to `areas` areas.
  class Scratch {
   public:
    static Result<Scratch> make(const Device& device, int areas);

   private:
    friend class SampleDepth;
    Buffer counts_;
  };
  static Result<SampleDepth> make(const Device& device);
  /// results: DepthSample[count]
  void record(Recorder& recorder, const Input& in, const Scratch& scratch, const Buffer& results, Size size) const;

 private:
  Kernel kernel_;
};

}  // namespace duo::vk
