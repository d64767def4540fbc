#pragma once

#include "stages/depthwise16/depthwise16.h"
#include "vulkan/recorder.h"
#include "vulkan/tensor.h"

namespace duo::vk {

/// A layer in the order of lanes, 32 bits a word: biases, shifts, and for each two places of the window a pair of weights a
/// channel, the first place's in the low half; what the last pair lacks is 0.
std::size_t packed_words(const duo::Depthwise16& layer);
void pack(const duo::Depthwise16& layer, std::span<std::int32_t> packed);

/// Depthwise convolutions on a device; the contract is in depthwise16.h.
class Depthwise16 {
 public:
  static Result<Depthwise16> make(const Device& device);
  /// `constants` holds what pack() made from word `at` on.
  void record(Recorder& recorder, const duo::Depthwise16& layer, const Buffer& constants, std::size_t at, const Tensors16& x,
              const Tensors16& y) const;

 private:
  Kernel kernel_;
};

}  // namespace duo::vk
