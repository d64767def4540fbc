#pragma once

#include "stages/lucas_kanade/lucas_kanade.h"
#include "vulkan/recorder.h"

namespace duo::vk {

/// The last fraction of a pixel on a device; the contract is in lucas_kanade.h.
class LucasKanade {
 public:
  /// duo::LucasKanade on the device.
  struct Input {
    BufferView<std::uint8_t> left = {}, right = {};
    BufferView<std::uint16_t> d_q4 = {};
    int max_disparity = 0;
  };
  static Result<LucasKanade> make(const Device& device);
  /// `clear`: a number that the device knows; above 0, see next_clear(), the disparities stay as they are.
  void record(Recorder& recorder, const Input& in, const Buffer& clear, BufferView<std::uint16_t> dst, Size size) const;

 private:
  Kernel kernel_;
};

}  // namespace duo::vk
