// The fingers of one hand, from frame to frame.
#pragma once

#include "duoptic/detector.h"
#include "duoptic/person.h"
#include "trackers/body/frame_view.h"
#include "trackers/body/joints.h"

namespace duo::body {

/// The joints of a hand's fingers in one frame, as the network of hands has them after the wrist: the thumb's first, from the
/// roots to the tips.
struct FingerPlaces {
  std::array<Vec3, kFingerJoints> p = {};  // metres, rig frame
  std::array<Covariance3, kFingerJoints> covariance = {};
  std::array<bool, kFingerJoints> seen = {};  // on a surface of the frame, and by the camera
};

/// Fingers on the rays of the network's points: as deep as the hand's surfaces and, where fingers are too thin for these or
/// hidden, as the hand's shape says that the network imagines. `hand_z_m`: where the hand is by the body.
///
/// None where fewer than a third of the points lie on surfaces near there.
std::optional<FingerPlaces> place_fingers(const FrameView& frame, const SeenHand& hand, double hand_z_m);

/// Follows the fingers of one hand.
class Fingers {
 public:
  explicit Fingers(bool left) : left_(left) {}
  /// `hand`: of this frame; null where the network of hands is not sure of one. `body`: as fitted in this frame; fingers that
  /// are not seen go along with its wrist.
  void track(const FrameView& frame, const SeenHand* hand, const Places& body);
  /// Fills the hand's joints of `person`, whose skeleton is kBodyHands and whose body is filled.
  void publish(Person& person) const;

 private:
  static constexpr double kMostHidden = 5;  // ticks after which fingers are lost

  JointId wrist() const { return left_ ? JointId::kLeftWrist : JointId::kRightWrist; }

  bool left_;
  double hidden_ = kMostHidden + 1;  // ticks
  FingerPlaces found_;
  Vec3 wrist_;  // in the last frame
};

}  // namespace duo::body
