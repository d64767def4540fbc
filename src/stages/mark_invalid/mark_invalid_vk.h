#pragma once

#include "stages/mark_invalid/mark_invalid.h"
#include "vulkan/recorder.h"

namespace duo::vk {

/// Winners to disparities on a device; the contract is in mark_invalid.h.
class MarkInvalid {
 public:
  /// Inside pictures may be absent, both or none.
  struct Input {
    BufferView<std::int16_t> winner = {};
    BufferView<std::uint8_t> left_inside = {}, right_inside = {};
    int max_disparity = 0;
  };
  static Result<MarkInvalid> make(const Device& device);
  void record(Recorder& recorder, const Input& in, BufferView<std::uint16_t> dst, Size size) const;

 private:
  Kernel kernel_;
};

}  // namespace duo::vk
