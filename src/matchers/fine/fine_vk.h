// The fine matcher has no kernels: a device leaves it to the processor.
#pragma once

#include "matchers/fine/fine.h"
#include "matchers/match_vk.h"
#include "vulkan/recorder.h"

namespace duo::vk {

class Fine {
 public:
  /// Errors  always
  static Result<Fine> make(const Device&, const FineParams&, const MatchSetup&) {
    return Error{ErrorCode::kUnsupported, "set up matcher fine on a device: it has no kernels"};
  }
  void record(Recorder&, const MatchInput&, const MatchOutput&) const {}
};

}  // namespace duo::vk
