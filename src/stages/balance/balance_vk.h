#pragma once

#include "stages/balance/balance.h"
#include "vulkan/recorder.h"

namespace duo::vk {

/// Brightness balance on a device; the contract is in balance.h.
class Balance {
 public:
  /// GrayPair on the device; the inside pictures may be absent, both or none.
  struct Input {
    BufferView<std::uint8_t> left = {}, right = {}, left_inside = {}, right_inside = {};
  };
  /// Cells, sums of their rows and the table; one for each recording that may run at the same time as another.
  class Scratch {
   public:
    /// Errors  out of memory
    static Result<Scratch> make(const Device& device, Size size);

   private:
    friend Balance;
    Size size_;
    Buffer cells_, census_, rows_, table_;
  };
  static Result<Balance> make(const Device& device);
  /// `clear`: null, or one word: where it is above 0 `unbalanced` is kClearUnbalanced, else 0.
  void record(Recorder& recorder, const Input& pair, int max_disparity, const Buffer* clear, const Scratch& scratch,
              BufferView<std::uint8_t> dst, Size size) const;

 private:
  Kernel cells_, census_, sums_, table_, look_up_;
};

}  // namespace duo::vk
