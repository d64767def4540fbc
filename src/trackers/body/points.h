// Where the joints are in the picture, by the detector's points.
#pragma once

#include <algorithm>

#include "duoptic/detector.h"
#include "duoptic/image.h"
#include "trackers/body/joints.h"

namespace duo::body {

/// A joint's centre as the network sees it.
///
/// Units  pixels of the rectified left picture; sigma_px: one standard deviation along each axis; visibility 0 .. 1
struct Point {
  Vec2 at_px;
  double sigma_px = 0;
  double visibility = 0;
  bool inside = false;  // in the picture

  /// Somebody nearer stands before it: the network only guesses where it is.
  void hide() {
    constexpr double kHidden = 0.1, kLessSharp = 3;
    if (visibility > kHidden) sigma_px *= kLessSharp;
    visibility = std::min(visibility, kHidden);
  }
};
using Points = PerJoint<Point>;

/// Points of the joints' centres. The network marks the body's outline as people see it: hips where the thigh bends, shoulders
/// on the bone that shows. Joint centres, as skeletons have them, lie beside, in widths of the
/// shoulders.
///
/// `ahead_m`: how far hips and head are marked off in this frame, across the trunk to the right of the picture; `hips_low_m`:
/// how far this person's hips are, down along it.
///
/// Shape   pelvis, spine, chest and neck have none
/// Source  the offsets of shoulders, hips and head and the share of wrists and knees: means over pictures of four rendered
///         people whose joints are those of their skeleton; that of elbows: chosen on the shared clips, on their copies and
///         synthetic ones of seeds 501 and 502, for the full network of bodies (docs/measurements.md)
Points points_of(const SeenBody& body, BodyModel model, Size picture, double px_per_m, double shoulder_width_m, double ahead_m,
                 double hips_low_m);

/// By how much a lifted arm takes its shoulder along, towards the head; the mark stays where it was.
///
/// Units   widths of the shoulders
/// Source  chosen on the shared clips, whose shoulders rise with their arms (docs/measurements.md)
inline constexpr double kLift = 0.03;
/// How far an arm is lifted to its side, as it shows in the picture: 0 hanging or forward, 1 by 50 degrees or more.
/// `width_px`: of the shoulders, head on.
double lifted(const SeenBody& body, bool left, double width_px);

/// How far the hand's network moved hand and wrist from where the body's network has them.
///
/// Units  px of the picture
struct HandShift {
  Vec2 palm, wrist;
};

/// Puts hand and wrist where the hand's network sees them: the centre of the palm lies 65 % of the way from the wrist to the
/// middle knuckle.
HandShift take_hand(const SeenHand& hand, bool left, Points& points);
/// The same by the shift of the frame before.
void take_shift(const HandShift& shift, bool left, Points& points);

/// Directions from the right shoulder or hip to the left one, as the network imagines them in space.
///
/// Units  length 1, rig frame
struct Across {
  Vec3 shoulders, hips;
};
/// `ray`: the viewing ray of the body, along which the network takes itself to look.
Across across_of(const SeenBody& body, Vec3 ray);

}  // namespace duo::body
