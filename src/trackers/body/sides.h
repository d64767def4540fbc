// Whether the network of bodies takes left for right.
#pragma once

#include "trackers/body/scene.h"
#include "trackers/body/seen_trunk.h"

namespace duo::body {

/// Judges the marks of one person from frame to frame. They are exchanged only of who is expected to show the back, for a
/// short while and after frames that agree on the sides. After frames that show nothing of the person, or a long step between
/// frames, it may have turned.
class Sides {
 public:
  /// Whether the marks of this frame are to be exchanged. `ticks`: since the last frame.
  bool are_exchanged(const SeenBody& seen, const TrunkCorners& expected, double ticks);
  /// The person was missed: what is expected is no longer sure.
  void forget() { *this = {}; }

 private:
  int agreed_ = 0;        // frames, up to the last exchange, that had the sides where they were expected
  double exchanged_ = 0;  // ticks for which they have been exchanged
};

/// The same of the legs alone: of who walks across the view the network takes one for the other in single frames.
class LegSides {
 public:
  /// Exchanges the points of knees, ankles and feet where each leg is marked much nearer to where the other one is expected.
  /// `ticks`: since the last frame.
  void put_right(Scene& scene, double ticks);
  /// The person was missed: what is expected is no longer sure.
  void forget() { *this = {}; }

 private:
  int agreed_ = 0;        // frames, up to the last exchange, in which each leg was where it was expected
  double exchanged_ = 0;  // ticks for which they have been exchanged
};

}  // namespace duo::body
