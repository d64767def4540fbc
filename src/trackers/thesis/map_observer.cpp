#include "trackers/thesis/map_observer.h"

#include "trackers/thesis/place_joints.h"

namespace duo::thesis {

MapObserver::MapObserver(Size size) : blobs_(size), points_({joint_window_px(size), joint_window_px(size)}) {}

void MapObserver::begin(const Frame& frame) {
  frame_ = &frame;
  blobs_.begin(pool_, frame);
}

JointPoints MapObserver::points_around(PlaceQ4 joint) {
  return points_.learn(pool_, frame_->left, joint_window(frame_->left.size(), joint), joint);
}

void MapObserver::observe(const Expectation& expected, Observation& seen) {
  const auto count = static_cast<std::size_t>(expected.count);
  blobs_.find(pool_, {expected.joints.data(), count}, seen.colors);
  for (std::size_t i = 0; i < count; ++i) {
    const JointPoints& stored = (*expected.points)[i];
    const ExpectedJoint& joint = expected.joints[i];
    const auto matches = points_.find(pool_, frame_->left, joint.target.window, stored);
    seen.joints[i] =
        ref::place_joint({joint.at, &seen.colors[i], &points_.seen(), matches, stored.to_joint}, frame_->disparity.d_q4);
  }
}

}  // namespace duo::thesis
