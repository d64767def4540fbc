#pragma once

#include "stages/noise/noise.h"
#include "vulkan/recorder.h"

namespace duo::vk {

/// The noise of a pair on a device; the contract is in noise.h.
class Noise {
 public:
  /// The bins; one for each recording that may run at the same time as another.
  class Scratch {
   public:
    /// Errors  out of memory
    static Result<Scratch> make(const Device& device);

   private:
    friend Noise;
    Buffer bins_;
  };
  static Result<Noise> make(const Device& device);
  /// `noise_q4`: one word.
  void record(Recorder& recorder, BufferView<std::uint8_t> left, BufferView<std::uint8_t> right, const Scratch& scratch,
              const Buffer& noise_q4, Size size) const;

 private:
  Kernel blocks_, level_;
};

}  // namespace duo::vk
