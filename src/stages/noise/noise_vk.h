#pragma once

#include "stages/noise/noise.h"
#include "stages/types/block_measure_vk.h"

namespace duo::vk {

/// The noise of a pair on a device; the contract is in noise.h.
class Noise {
 public:
  using Scratch = BlockMeasure::Scratch;
  static Result<Noise> make(const Device& device);
  static Result<Scratch> make_scratch(const Device& device);
  /// `noise_q4`: one word.
  void record(Recorder& recorder, BufferView<std::uint8_t> left, BufferView<std::uint8_t> right, const Scratch& scratch,
              const Buffer& noise_q4, Size size) const;

 private:
  BlockMeasure measure_;
};

}  // namespace duo::vk
