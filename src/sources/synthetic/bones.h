// The bones of a person and how they are posed. The person's frame: origin on the floor between the feet, x to the person's
// left, y down, z to the back; a standing person looks along -z, towards the cameras.
#pragma once

#include <array>

#include "duoptic/geometry.h"
#include "duoptic/skeleton.h"

namespace duo::synthetic {

/// The person's own sides; the cameras see the right arm on the left.
enum Side : int { kRightSide = 0, kLeftSide = 1 };
/// Sign of x on that side.
inline double outwards(int side) { return side == kRightSide ? -1 : 1; }

/// An arm in the frame of its shoulder: x outwards, y down, z to the back, whichever side.
struct ArmPose {
  Vec3 wrist_m;
  Vec3 elbow;    // the elbow is bent towards there
  Vec3 palm;     // the palm faces there
  Vec3 fingers;  // added to the forearm's direction: bends the wrist
  double curl_degrees = 18;
  double pinch = 0;  // 1: the tips of thumb and index finger touch
};

/// A leg in the person's frame: x outwards, y down, z to the back, of a person of 1.75 m, whichever side.
struct LegPose {
  Vec3 ankle_m{0.115, -0.095, 0.03};
  Vec3 knee{0.15, 0, -1};   // the knee is bent towards there
  double toes_degrees = 0;  // how far they point down
};

struct Pose {
  std::array<ArmPose, 2> arms;
  std::array<LegPose, 2> legs;
  Vec3 hips_m;                                 // off where they are when the person stands
  double lean_degrees = 0, twist_degrees = 0;  // of the torso, about z and y
  double bow_degrees = 0;                      // of the torso, forwards
  double look_degrees = 0, nod_degrees = 0;    // of the head
};

/// A finger in the frame of its hand, where y goes to the fingers and z out of the palm: where it leaves the palm, where it
/// bends, and the middle of its tip.
struct Finger {
  Vec3 root_m, bend_m, tip_m;
};
/// The thumb first, of a person of 1.75 m.
using Fingers = std::array<Finger, kFingers>;
Fingers make_fingers(const ArmPose& pose, int side);

/// Two bones and what hangs on them; the frames have y along their bone.
struct Limb {
  Rigid3 person_from_upper, person_from_lower, person_from_end;
  Vec3 root_m, middle_m, end_m;
};

struct Bones {
  double scale = 1;                            // of every length, 1 for a person of 1.75 m
  Rigid3 person_from_torso, person_from_head;  // at rest, the torso's frame is the person's; the head's origin is its middle
  std::array<Limb, 2> arms, legs;
  std::array<Vec3, 2> hands_m;  // palm centres
  std::array<Vec3, 2> feet_m;   // where the toes begin
  std::array<Fingers, 2> fingers;
  Vec3 head_m, neck_m, pelvis_m;  // as in skeletons of animation: the head's bone ends below the crown
};

/// Lengths in metres of a person of 1.75 m.
inline constexpr double kUpperArm_m = 0.29, kForearm_m = 0.26, kPalm_m = 0.068, kThigh_m = 0.42, kShin_m = 0.41,
                        kShoulderHeight_m = 1.43, kHeadHeight_m = 1.635;

/// Bone lengths do not depend on the pose: a wrist out of reach is brought nearer.
Bones make_bones(const Pose& pose, double scale);

}  // namespace duo::synthetic
