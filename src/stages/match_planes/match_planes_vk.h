#pragma once

#include "stages/match_planes/match_planes.h"
#include "vulkan/recorder.h"

namespace duo::vk {

/// Census and gradients of one view on a device; the contract is in match_planes.h.
class MatchPlanes {
 public:
  /// The picture that holds a view's planes, packed as match_planes_params.h says.
  static Size packed_size(Size size);
  static Result<MatchPlanes> make(const Device& device);
  /// `inside` may be absent = all inside; `noise_q4`: one word, from which the dead zone follows; `clear`: one word,
  /// above 0 for clear pictures; `planes` is of packed_size(size).
  void record(Recorder& recorder, BufferView<std::uint8_t> gray, BufferView<std::uint8_t> inside, const Buffer& noise_q4,
              const Buffer& clear, BufferView<std::uint32_t> planes, Size size) const;

 private:
  Kernel kernel_;
};

}  // namespace duo::vk
