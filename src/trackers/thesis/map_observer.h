// The thesis tracker's look at the maps of a frame, on the CPU.
#pragma once

#include "trackers/thesis/blob.h"
#include "trackers/thesis/points.h"

namespace duo::thesis {

/// What joints look like, and where they are by their colours and their points. On a device vk::ObserveJoints looks instead.
class MapObserver {
 public:
  explicit MapObserver(Size size);

  /// Before the rest: the maps to look at, which must live until the next call.
  void look_at(const Frame& frame);
  /// The hue around a click, 256 = full circle.
  ///
  /// Errors  none where no pixel fits its own model: gray, or too dark
  std::optional<std::uint8_t> hue_at(Pixel click) { return blobs_.learn(pool_, click); }
  JointPoints points_around(PlaceQ4 joint);
  void observe(const Expectation& expected, Observation& seen);

 private:
  Pool pool_{1};
  const Frame* frame_ = nullptr;
  BlobFinder blobs_;
  PointFinder points_;
};

}  // namespace duo::thesis
