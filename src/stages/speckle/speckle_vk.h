#pragma once

#include "stages/speckle/speckle.h"
#include "vulkan/recorder.h"

namespace duo::vk {

/// Removal of small islands on a device, in place; the contract is in speckle.h.
///
/// Union-find in four dispatches, whatever the islands: Playne, Hawick, "A new algorithm for parallel connected-component
/// labelling on GPUs", 2018, begun with runs, and with the way up halved as it is gone.
class RemoveSpeckle {
 public:
  /// Labels and counts; one for each recording that may run at the same time as another.
  class Scratch {
   public:
    /// Errors  out of memory
    static Result<Scratch> make(const Device& device, Size size);

   private:
    friend RemoveSpeckle;
    Size size_;
    Buffer labels_, pixels_;
  };
  static Result<RemoveSpeckle> make(const Device& device);
  void record(Recorder& recorder, BufferView<std::uint16_t> d_q4, int step_q4, int smallest, const Scratch& scratch,
              Size size) const;

 private:
  Kernel runs_, join_, count_, remove_;
};

}  // namespace duo::vk
