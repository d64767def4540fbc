// What a frame offers to the trackers of people.
#pragma once

#include <cmath>

#include "duoptic/detector.h"
#include "duoptic/image.h"
#include "duoptic/window.h"
#include "trackers/body/joints.h"
#include "trackers/body/lift.h"

namespace duo::body {

struct FrameView {
  DepthView depth;
  View<const Rgb8> picture;
  double frame_s = 1.0 / 30;
  BodyModel model = BodyModel::kLite;    // that marked the points
  View<const std::uint8_t> covered;      // not 0: somebody nearer was taken out there; empty: nobody was
  View<const std::uint8_t> margin = {};  // not 0: the camera sees nothing there; empty: it sees all
  Window matched = {};                   // where depth was looked for; empty: everywhere

  /// Since the frame before, in the tracker's unit.
  double ticks() const { return ticks_in(frame_s); }
  bool is_covered(Vec2 at_px) const { return is_set(covered, at_px); }
  /// Whether depth was looked for at a place.
  bool is_matched(Vec2 at_px) const {
    return matched.empty() || matched.contains(static_cast<int>(std::floor(at_px.y)), static_cast<int>(std::floor(at_px.x)));
  }
  /// Whether the camera sees a place.
  bool shows(Vec2 at_px) const {
    return at_px.x >= 0 && at_px.y >= 0 && at_px.x <= picture.width() - 1 && at_px.y <= picture.height() - 1 &&
           !is_set(margin, at_px);
  }

 private:
  static bool is_set(View<const std::uint8_t> mask, Vec2 at_px) {
    const int x = static_cast<int>(at_px.x + 0.5), y = static_cast<int>(at_px.y + 0.5);
    return at_px.x >= 0 && at_px.y >= 0 && x < mask.width() && y < mask.height() && mask.at(y, x) != 0;
  }
};

}  // namespace duo::body
