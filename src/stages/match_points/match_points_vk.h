#pragma once

#include "stages/match_points/match_points.h"
#include "stages/types/sift_list.h"
#include "vulkan/recorder.h"

namespace duo::vk {

/// Matching of several pairs of lists on a device; the contract is in match_points.h.
class MatchPoints {
 public:
  /// As many lists of stored as of seen points; predicted places (PredictedPlace, a row of the stored lists' capacity each) may
  /// be absent.
  struct Input {
    const Buffer* stored = nullptr;
    const Buffer* seen = nullptr;
    const Buffer* predicted = nullptr;
    SiftListShape stored_shape{}, seen_shape{};
  };
  static Result<MatchPoints> make(const Device& device);
  /// matches: PointMatch, a row of the stored lists' capacity each; none beyond the stored points
  void record(Recorder& recorder, const Input& in, const MatchPointsParams& params, const Buffer& matches) const;

 private:
  Kernel kernel_;
};

}  // namespace duo::vk
