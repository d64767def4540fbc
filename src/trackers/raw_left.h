// Between the raw left picture, where the user clicks, and the rig frame.
#pragma once

#include <array>
#include <optional>
#include <span>
#include <vector>

#include "core/lens.h"
#include "duoptic/result.h"
#include "duoptic/tracker.h"

namespace duo::arm {

inline constexpr std::size_t kMostArms = 2;
inline constexpr std::array<const Skeleton*, kMostArms> kArms = {&kRightArm, &kLeftArm};

/// The joints of an arm in the order of its skeleton.
enum class Part : std::uint8_t { kShoulder, kElbow, kHand };
inline constexpr std::size_t kParts = 3;
inline constexpr std::size_t index_of(Part part) { return static_cast<std::size_t>(part); }

class RawLeft {
 public:
  /// Errors  no geometry, a time from frame to frame that is none
  static Result<RawLeft> of(const TrackerSetup& setup);

  const Rectified& geometry() const { return geometry_; }
  /// The clicks of one arm on the rectified picture, in the order of Part.
  ///
  /// Errors  not an arm's skeleton, a joint without a click; outside the raw picture, or of the part that both cameras see
  Result<std::array<Vec2, kParts>> rectified(const Selection& selection) const;
  /// Sets the raw pixel of a joint; one that the lens does not see keeps the pixel it had.
  void set_pixel(Joint& joint) const;
  /// Refuses a frame, or a number of arms, that a tracker cannot start on.
  Result<void> check(const Frame& frame, std::size_t arms) const;

 private:
  RawLeft(const Camera& camera, const Rectified& geometry) : lens_(camera), geometry_(geometry) {}
  Lens lens_;
  Rectified geometry_;
};

/// A person per selection, numbered from 1, every joint lost.
std::vector<Person> persons_of(std::span<const Selection> selections);

}  // namespace duo::arm
