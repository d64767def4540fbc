#pragma once

#include "stages/types/sift_list.h"
#include "trackers/thesis/place_joints.h"
#include "vulkan/recorder.h"

namespace duo::vk {

/// Places of several joints on a device; the contract is in place_joints.h.
class PlaceJoints {
 public:
  /// One of each a joint: expected: PlaceQ4; colors: AreaSums; seen: its list of points; matches and to_joint: PointMatch and
  /// PlaceQ4, a row of the stored lists' capacity, at most JointPoints::kCapacity.
  struct Input {
    const Buffer *expected = nullptr, *colors = nullptr, *seen = nullptr, *matches = nullptr, *to_joint = nullptr;
    SiftListShape stored_shape{}, seen_shape{};
    BufferView<std::uint16_t> d_q4 = {};
  };
  static Result<PlaceJoints> make(const Device& device);
  /// joints: ObservedJoint, one a list
  void record(Recorder& recorder, const Input& in, const Buffer& joints, Size size) const;

 private:
  Kernel kernel_;
};

}  // namespace duo::vk
