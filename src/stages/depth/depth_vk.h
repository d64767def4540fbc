#pragma once

#include "stages/depth/depth.h"
#include "vulkan/recorder.h"

namespace duo::vk {

/// Disparity to depth on a device; the contract is in depth.h. A device may round a division by 2.5 ulp, so kernels look up
/// what the reference answers to each of the 65536 disparities.
class Depth {
 public:
  /// Runs work on the device: the table has to get there.
  static Result<Depth> make(Device& device, float focal_baseline_px_mm);
  void record(Recorder& recorder, BufferView<std::uint16_t> d_q4, BufferView<std::uint16_t> depth_mm, Size size) const;

 private:
  Kernel kernel_;
  Buffer table_;
};

}  // namespace duo::vk
