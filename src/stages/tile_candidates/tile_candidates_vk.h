#pragma once

#include "stages/tile_candidates/tile_candidates.h"
#include "vulkan/recorder.h"

namespace duo::vk {

/// Choice of candidates on a device; the contract is in tile_candidates.h.
class TileCandidates {
 public:
  /// duo::TileCandidates on the device.
  struct Input {
    BufferView<std::int16_t> checked = {}, unchecked = {};
    int grow = 1, margin = 1;
  };
  static Result<TileCandidates> make(const Device& device);
  /// The sets of a picture of `size`, as TileSets::shape32() says; winners come from half_of() it.
  void record(Recorder& recorder, const Input& in, BufferView<std::uint32_t> sets, Size size, int max_disparity) const;

 private:
  Kernel kernel_;
};

}  // namespace duo::vk
