#pragma once

#include "stages/blur/blur.h"
#include "vulkan/recorder.h"

namespace duo::vk {

/// The blur of a pair on a device; the contract is in blur.h.
class Blur {
 public:
  /// The bins; one for each recording that may run at the same time as another.
  class Scratch {
   public:
    /// Errors  out of memory
    static Result<Scratch> make(const Device& device);

   private:
    friend Blur;
    Buffer bins_;
  };
  static Result<Blur> make(const Device& device);
  /// `blur_q4`: one word.
  void record(Recorder& recorder, BufferView<std::uint8_t> left, BufferView<std::uint8_t> right, const Scratch& scratch,
              const Buffer& blur_q4, Size size) const;

 private:
  Kernel blocks_, ratio_;
};

}  // namespace duo::vk
