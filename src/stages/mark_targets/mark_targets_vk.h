#pragma once

#include <cstddef>
#include <span>

#include "stages/mark_targets/mark_targets.h"
#include "vulkan/recorder.h"

namespace duo::vk {

/// Marks of all targets on a device; the contract is in mark_targets.h.
class MarkTargets {
 public:
  /// duo::MarkTargets on the device. What changes from frame to frame lies in `targets`, as write() leaves it there.
  struct Input {
    BufferView<std::uint8_t> hue, saturation, value;
    const Buffer* targets = nullptr;
  };
  static Result<MarkTargets> make(const Device& device);
  void record(Recorder& recorder, const Input& in, BufferView<std::uint8_t> marks, Size size) const;

  /// Bytes of Input::targets.
  static std::size_t target_bytes();
  static void write(std::span<const Target> targets, std::span<std::byte> to);

 private:
  Kernel kernel_;
};

}  // namespace duo::vk
