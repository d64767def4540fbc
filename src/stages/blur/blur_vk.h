#pragma once

#include "stages/blur/blur.h"
#include "stages/types/block_measure_vk.h"

namespace duo::vk {

/// The blur of a pair on a device; the contract is in blur.h.
class Blur {
 public:
  using Scratch = BlockMeasure::Scratch;
  static Result<Blur> make(const Device& device);
  static Result<Scratch> make_scratch(const Device& device);
  /// `blur_q4`: one word.
  void record(Recorder& recorder, BufferView<std::uint8_t> left, BufferView<std::uint8_t> right, const Scratch& scratch,
              const Buffer& blur_q4, Size size) const;

 private:
  BlockMeasure measure_;
};

}  // namespace duo::vk
