#pragma once

#include <cstddef>
#include <span>

#include "stages/mark_targets/mark_targets.h"
#include "vulkan/recorder.h"

namespace duo::vk {

/// Marks of all targets on a device; the contract is in mark_targets.h.
class MarkTargets {
 public:
  /// duo::MarkTargets on the device; the two depth pictures may be absent, for the recording's life. What changes from frame to
  /// frame lies in `wanted`, as write() leaves it there.
  struct Input {
    BufferView<std::uint8_t> hue, saturation, value;
    BufferView<std::uint16_t> d_q4 = {}, background_q4 = {};
    const Buffer* wanted = nullptr;
  };
  static Result<MarkTargets> make(const Device& device);
  void record(Recorder& recorder, const Input& in, BufferView<std::uint8_t> marks, Size size) const;

  /// Bytes of `wanted` for so many likelihood tables.
  static std::size_t wanted_bytes(std::size_t tables);
  /// `wanted` holds all that is given.
  static void write(std::span<const Target> targets, std::span<const ColorLikelihood> likelihoods, std::span<std::byte> wanted);

 private:
  Kernel kernel_;
};

}  // namespace duo::vk
