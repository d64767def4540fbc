#pragma once

#include "stages/match_around/match_around.h"
#include "vulkan/recorder.h"

namespace duo::vk {

/// One level of the thesis's matcher on a device; the contract is in match_around.h.
class MatchAround {
 public:
  /// duo::MatchAround on the device; inside pictures may be absent (both), and so may the coarser level.
  struct Input {
    BufferView<std::uint8_t> left = {}, right = {}, left_inside = {}, right_inside = {};
    BufferView<std::int16_t> coarser = {};
    int radius = 0;
  };
  static Result<MatchAround> make(const Device& device);
  void record(Recorder& recorder, const Input& in, BufferView<std::int16_t> dst, Size size) const;

 private:
  Kernel kernel_;
};

}  // namespace duo::vk
