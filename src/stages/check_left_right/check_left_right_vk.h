#pragma once

#include "stages/check_left_right/check_left_right.h"
#include "vulkan/recorder.h"

namespace duo::vk {

/// Left-right check on a device; the contract is in check_left_right.h.
class CheckLeftRight {
 public:
  /// duo::CheckLeftRight on the device; inside pictures may be absent, both or none.
  struct Input {
    BufferView<std::int16_t> left = {}, right = {};
    BufferView<std::uint8_t> left_inside = {}, right_inside = {};
    int tolerance = 1, reach = 0;
  };
  static Result<CheckLeftRight> make(const Device& device);
  /// check_winners().
  void record_winners(Recorder& recorder, const Input& in, BufferView<std::int16_t> dst, Size size) const;
  /// check_left_right().
  void record(Recorder& recorder, const Input& in, BufferView<std::uint16_t> fine, BufferView<std::uint16_t> dst,
              Size size) const;

 private:
  Kernel kernel_;
};

}  // namespace duo::vk
