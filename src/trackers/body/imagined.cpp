#include "trackers/body/imagined.h"

#include <algorithm>

#include "trackers/body/fit.h"

namespace duo::body {

Places imagined(const FrameView& frame, const SeenBody& seen, const Points& points, double trunk_z) {
  using enum BodyPoint;
  const auto depth_of = [&](BodyPoint point) { return seen.at(point).world_m().z; };
  const double trunk = (depth_of(kLeftShoulder) + depth_of(kRightShoulder) + depth_of(kLeftHip) + depth_of(kRightHip)) / 4;
  Places out;
  const auto put = [&](JointId id, BodyPoint point) {
    const double z = std::clamp(trunk_z + 0.1 + depth_of(point) - trunk, kAnyDepth.near_m, kAnyDepth.far_m);
    out[id] = frame.depth.geometry->unproject(points[id].at_px, z);
  };
  put(JointId::kHead, kLeftEar);
  put(JointId::kLeftShoulder, kLeftShoulder);
  put(JointId::kRightShoulder, kRightShoulder);
  put(JointId::kLeftElbow, kLeftElbow);
  put(JointId::kRightElbow, kRightElbow);
  put(JointId::kLeftWrist, kLeftWrist);
  put(JointId::kRightWrist, kRightWrist);
  put(JointId::kLeftHand, kLeftIndex);
  put(JointId::kRightHand, kRightIndex);
  put(JointId::kLeftHip, kLeftHip);
  put(JointId::kRightHip, kRightHip);
  put(JointId::kLeftKnee, kLeftKnee);
  put(JointId::kRightKnee, kRightKnee);
  put(JointId::kLeftAnkle, kLeftAnkle);
  put(JointId::kRightAnkle, kRightAnkle);
  put(JointId::kLeftFoot, kLeftFootIndex);
  put(JointId::kRightFoot, kRightFootIndex);
  complete(out);
  return out;
}

}  // namespace duo::body
