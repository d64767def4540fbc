#pragma once

#include "stages/sums/sums.h"
#include "vulkan/area.h"
#include "vulkan/recorder.h"

namespace duo::vk {

/// Sums over areas on a device; the contract is in sums.h.
class Sums {
 public:
  /// duo::Sums on the device, for `count` areas at once: `areas` holds a DeviceArea each. The pictures may be absent; without
  /// marks all pixels count.
  struct Input {
    const Buffer* areas = nullptr;
    int count = 0;
    BufferView<std::uint8_t> marks = {}, hue = {};
    BufferView<std::uint16_t> d_q4 = {};
  };
  /// A sum for each workgroup, for up to `areas` areas.
  class Scratch {
   public:
    static Result<Scratch> make(const Device& device, int areas);

   private:
    friend class Sums;
    Buffer partial_;
  };
  static Result<Sums> make(const Device& device);
  /// results: AreaSums[count]
  void record(Recorder& recorder, const Input& in, const Scratch& scratch, const Buffer& results, Size size) const;

 private:
  Kernel kernel_;
};

}  // namespace duo::vk
