// One instant for the tests of sinks and pictures.
#pragma once

#include "tests/arm_poses.h"

namespace duo::test {

inline TrackHeader clip_header(Size size) {
  TrackHeader r;
  r.sources = {"left.avi", "odd \"name\"\xFF.avi"};
  r.engine = "simd";
  r.matcher = "pyramid";
  r.matcher_preset = "default";
  r.tracker = "arm";
  r.skeletons = {&kRightArm};
  r.rectified = {{500, size.width / 2.0, size.height / 2.0, 0.125}, size, {}, {}};
  r.size = size;
  return r;
}

/// A frame with everything the sinks look at: a wall at 2 m, gray, and an arm.
struct Moment {
  explicit Moment(Size size) {
    left.pixels = Image<Rgb8>(size);
    frame.color = Image<Rgb8>(size);
    frame.disparity.d_q4 = Image<std::uint16_t>(size);
    for (int y = 0; y < size.height; ++y)
      for (int x = 0; x < size.width; ++x) {
        left.pixels.at(y, x) = {40, 80, 200};
        frame.color.at(y, x) = {200, 40, 40};
        frame.disparity.d_q4.at(y, x) = 500;  // 500 px * 0.125 m / 2 m = 31.25 px
      }
    people = {person_with(kRightArm)};
    set(kHand, {0.1, -0.25, 1.5}, 0.0125, 0.9, 30, 20.5, JointState::kSeen);
    set(kElbow, {-0.00001, 0, 2}, 0.25, 0.25, 12.345, 24, JointState::kInferred);
    set(kShoulder, {9, 9, 9}, 1.5, 0, 9, 9, JointState::kLost);
  }
  TrackedFrame tracked(std::int64_t number) const {
    return {number, static_cast<double>(number) / 30, shared_left, shared_frame, people, {}};
  }
  void set(std::size_t j, Vec3 p_m, double sigma_m, double confidence, double u_px, double v_px, JointState state) {
    people[0].joints[j] = {.p_in_rig_m = p_m,
                           .cov_m2 = Covariance3::isotropic(sigma_m),
                           .state = state,
                           .confidence = confidence,
                           .u_px = u_px,
                           .v_px = v_px};
  }

  std::shared_ptr<Picture> shared_left = std::make_shared<Picture>();
  std::shared_ptr<Frame> shared_frame = std::make_shared<Frame>();
  Picture& left = *shared_left;
  Frame& frame = *shared_frame;
  std::vector<Person> people;
};

}  // namespace duo::test
