// What the thesis tracker observes in the maps of a frame, on the CPU.
#pragma once

#include "trackers/thesis/blob.h"
#include "trackers/thesis/points.h"

namespace duo::thesis {

/// The colours and points of joints, and where joints are by them. vk::ObserveJoints does the same on a device.
class MapObserver {
 public:
  explicit MapObserver(Size size);

  /// Takes the frame that the other calls are about; it must live until the next begin().
  void begin(const Frame& frame);
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
