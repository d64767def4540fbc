// Between the raw left picture, where the user clicks, and the rig frame.
#pragma once

#include <array>
#include <optional>

#include "core/lens.h"
#include "duoptic/result.h"
#include "duoptic/tracker.h"

namespace duo::arm {

inline constexpr std::size_t kMostArms = 2;

class RawLeft {
 public:
  /// Errors  no geometry, a time from frame to frame that is none
  static Result<RawLeft> of(const TrackerSetup& setup);

  const Rectified& geometry() const { return geometry_; }
  /// The clicks of one arm on the rectified picture, in the order of Joint.
  ///
  /// Errors  outside the raw picture, or of the part that both cameras see
  Result<std::array<Vec2, kArmJoints>> rectified(const ArmSelection& selection) const;
  /// Sets the raw pixel of a joint; one that the lens does not see keeps the pixel it had.
  void set_pixel(Keypoint& joint) const;
  /// Refuses a frame, or a number of arms, that a tracker cannot start on.
  Result<void> check(const Frame& frame, std::size_t arms) const;

 private:
  RawLeft(const Camera& camera, const Rectified& geometry) : lens_(camera), geometry_(geometry) {}
  Lens lens_;
  Rectified geometry_;
};

}  // namespace duo::arm
